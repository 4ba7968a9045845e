/* The C interface of the shared library. A run is led through its life by one thread at a time. */
#ifndef BOREPROP_H
#define BOREPROP_H

#ifndef SPACE
#include "lying.h"
#endif
#include "run.h"
#include "sentence.h"

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

enum { STRUCTURE_MEMBERS = sizeof(Structure) / sizeof(int) }; /* members of a Structure */

/* A digest of the sources that this was compiled from. */
EXPORT const char *boreprop_sources_digest(void);

/* A digest of the table of quantities that it was compiled for. */
EXPORT const char *boreprop_quantities_digest(void);

/* The sentence that says what a problem is. */
EXPORT void boreprop_sentence(const Problem *problem, char line[MESSAGE]);

/* A run of this structure (its members one after the other) at the end of its survey, with parameters in the order of the
   table of quantities; NULL, and the problem, if a value is out of range. The caller ends it with `boreprop_end`. The
   tolerance is that of the parameters; the other options are not checked. The ground is of so many layers, and made of
   numbers as ground.h says, or NULL. */
EXPORT Run *boreprop_start(
    const int structure[STRUCTURE_MEMBERS], const double *parameters, const Options *options, Count count,
    const double *measured_depth, const double *inclination, const double *azimuth, int layers, const double *ground,
    const Inputs *inputs, Problem *problem
);
EXPORT void boreprop_end(Run *run);

/* Drill leg after leg, to lengths[k] under inputs[which[k]], which are those where the leg starts. Unless rows[k] is
   negative, the outputs there become that row of the table, in which the next value of a row is `across` numbers on, and
   the next row `down`. Returns how many legs are drilled; if not all are, the problem is that of the next one. */
EXPORT Count boreprop_follow(
    Run *run, Count count, const double *lengths, const Inputs *inputs, const int *which, const int *rows,
    double *table, Count down, Count across, Problem *problem
);

/* Let the stabilizers have other clearances, m, from where the bit is; 0, and the problem, if that fails. */
EXPORT int boreprop_change_clearances(Run *run, const double *clearances, Problem *problem);

/* Drill on to the end of the integrator's next step, under the inputs as they are; 0, and the problem, if that fails. */
EXPORT int boreprop_step(Run *run, Problem *problem);

/* All outputs where the bit is, in the order of the table of quantities; returns how many. */
EXPORT int boreprop_outputs(Run *run, double out[MOST_OUTPUTS]);

/* The length drilled, m. */
EXPORT double boreprop_length(const Run *run);

/* How many steps were accepted and rejected, and how many bounds were met, since the start of the run. */
EXPORT void boreprop_statistics(const Run *run, double counts[3]);

/* How many numbers the state of the run has, which `boreprop_save` writes. */
EXPORT Count boreprop_state_size(const Run *run);
EXPORT void boreprop_save(const Run *run, double *state);

/* Go to a saved state of a run with the same system; 0, and the problem, if these numbers cannot be such a state.
   Nothing has changed then. */
EXPORT int boreprop_restore(Run *run, const double *state, Count count, Problem *problem);

/* How a BHA lies in holes that are given, row by row as `lie` of lying.h does, under a weight on bit, N, and its own at an
   inclination, rad. Returns how many rows are done; if not all are, there is a problem. */
EXPORT Count boreprop_lie(
    const int structure[STRUCTURE_MEMBERS], const double *parameters, double weight_on_bit, double inclination,
    Count rows, const double *loads, double *answers, Count count, const double *s, double *shapes, Problem *problem
);

#endif
