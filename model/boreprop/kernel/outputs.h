/* All outputs of the table of quantities where the bit is. */
#ifndef BOREPROP_OUTPUTS_H
#define BOREPROP_OUTPUTS_H

#ifdef SPACE
#include "space_outputs.h"
#else
#include "plane_outputs.h"
#endif

/* How many values `drilling_outputs` writes. */
static inline int output_count(Structure structure) {
    int count = 0;
    for (int k = 0; k < OUTPUT_COUNT; k++) count += value_count(OUTPUT_SIZE[k], structure);
    return count;
}

/* Every output of the table of quantities where the bit is, in its order; returns how many values. */
static inline int drilling_outputs(Drilling *d, double out[MOST_OUTPUTS]) {
    Present at = present(d);
    const Structure structure = d->system.structure;
    double *next = out;
    for (int k = 0; k < OUTPUT_COUNT; k++)
        for (int i = 0, count = value_count(OUTPUT_SIZE[k], structure); i < count; i++)
            *next++ = output(d, &at, (Output)k, i);
    return (int)(next - out);
}

/* Whether the outputs are finite. */
static inline int check_outputs(Structure structure, const double *outputs, Problem *problem) {
    for (int k = 0; k < OUTPUT_COUNT; k++)
        for (int i = 0; i < value_count(OUTPUT_SIZE[k], structure); i++)
            if (!check_finite(OUTPUT_NAME[k], is_list(OUTPUT_SIZE[k]) ? i + 1 : 0, *outputs++, problem)) return 0;
    return 1;
}

#endif
