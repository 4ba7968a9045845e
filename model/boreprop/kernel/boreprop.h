/* The C interface of the shared library. A run is led through its life by one thread at a time. */
#ifndef BOREPROP_H
#define BOREPROP_H

#include "run.h"

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* Which sources this was made from. */
EXPORT const char *boreprop_sources_digest(void);

/* Which table of quantities. */
EXPORT const char *boreprop_quantities_digest(void);

/* A run of n stabilizers at the end of its survey, with parameters in the order of the table of quantities; NULL, and
   `why`, where one is bad. To be ended with `boreprop_end`. */
EXPORT Run *boreprop_start(
    int n, const double *parameters, Count count, const double *measured_depth, const double *inclination,
    const Inputs *inputs, char why[MESSAGE]
);
EXPORT void boreprop_end(Run *run);

/* Drill leg after leg: to lengths[k] under forces[k]; where rows[k] is not negative the outputs there become that row
   of the table. Returns how many legs are drilled; if not all, `why` says what the next one met. */
EXPORT Count boreprop_follow(
    Run *run, Count count, const double *lengths, const double *forces, double active_weight_on_bit, const int *rows,
    double *table, char why[MESSAGE]
);

/* All outputs where the bit is, in the order of the table of quantities; returns how many. */
EXPORT int boreprop_outputs(Run *run, double out[MOST_OUTPUTS]);

/* m drilled. */
EXPORT double boreprop_length(const Run *run);

/* The integrator's own present step: ξ, h, where it ends, the part whose bound it meets there (−1: none), on which
   side; and how many steps were accepted and rejected, and how many bounds met. */
EXPORT void boreprop_step(const Run *run, double numbers[8]);

/* How many numbers `boreprop_save` writes: the state of the run. */
EXPORT Count boreprop_state_size(const Run *run);
EXPORT void boreprop_save(const Run *run, double *state);

/* Go to a state of a run with the same system; 0, and `why`, if these numbers cannot be one: nothing has changed. */
EXPORT int boreprop_restore(Run *run, const double *state, Count count, char why[MESSAGE]);

#endif
