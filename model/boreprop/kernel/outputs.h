/* All outputs of the table of quantities where the bit is. */
#ifndef BOREPROP_OUTPUTS_H
#define BOREPROP_OUTPUTS_H

#ifdef SPACE
#include "space_outputs.h"
#else
#include "plane_outputs.h"
#endif

/* How many values an output has: of most, one is known when this is compiled. */
static inline int count_of(const Drilling *d, Output which) { return OUTPUT_SIZE[which] == ONE ? 1 : d->count[which]; }

/* Every output of the table of quantities where the bit is, in its order, each value `across` numbers after the one before;
   returns how many there are. */
static inline int drilling_outputs(Drilling *d, double *out, Count across) {
    Present at;
    find_present(d, &at);
#define PUT(which)                                                                                                     \
    for (int i = 0; i < count_of(d, which); i++, out += across) *out = output(d, &at, which, i);
    EACH_OUTPUT(PUT)
#undef PUT
    return d->values;
}

/* Whether the outputs are finite. */
static inline int check_outputs(const Drilling *d, const double *outputs, Problem *problem) {
    for (int k = 0; k < OUTPUT_COUNT; k++)
        for (int i = 0; i < d->count[k]; i++)
            if (!check_finite(OUTPUT_NAME[k], is_list(OUTPUT_SIZE[k]) ? i + 1 : 0, *outputs++, problem)) return 0;
    return 1;
}

#endif
