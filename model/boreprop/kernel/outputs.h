/* All outputs of the table of quantities where the bit is. */
#ifndef BOREPROP_OUTPUTS_H
#define BOREPROP_OUTPUTS_H

#ifdef SPACE
#include "space_outputs.h"
#else
#include "plane_outputs.h"
#endif

/* Every output of the table of quantities where the bit is, in its order; returns how many values. */
static inline int drilling_outputs(Drilling *d, double out[MOST_OUTPUTS]) {
    Present at = present(d);
    for (int k = 0; k < d->values; k++) out[k] = output(d, &at, d->value[k].which, d->value[k].index);
    return d->values;
}

/* Whether the outputs are finite. */
static inline int check_outputs(const Drilling *d, const double *outputs, Problem *problem) {
    for (int k = 0; k < d->values; k++) {
        Value value = d->value[k];
        int number = is_list(OUTPUT_SIZE[value.which]) ? value.index + 1 : 0;
        if (!check_finite(OUTPUT_NAME[value.which], number, outputs[k], problem)) return 0;
    }
    return 1;
}

#endif
