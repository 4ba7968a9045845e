/* The kernel as a shared library, for the binding in Python. */
#include "run.h"

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* Which sources this was made from. */
EXPORT const char *boreprop_sources_digest(void) { return BOREPROP_SOURCES_DIGEST; }

/* Which table of quantities. */
EXPORT const char *boreprop_quantities_digest(void) { return QUANTITIES_DIGEST; }

/* A run of n stabilizers at the end of its survey, with parameters in the order of the table of quantities; NULL, and
   `why`, where one is bad. To be ended with `boreprop_end`. */
EXPORT Run *boreprop_start(
    int n, const double *parameters, Count count, const double *measured_depth, const double *inclination,
    const Inputs *inputs, char why[MESSAGE]
) {
    Survey survey = {count, measured_depth, inclination};
    System system = system_of(n, parameters);
    Run *run = calloc(1, sizeof *run);
    strcpy(why, "memory: must have room for a run, got too little");
    if (run && run_prepare(run, &system, why) == DONE && run_start(run, &survey, *inputs, why) == DONE) return run;
    run_end(run);
    return NULL;
}

EXPORT void boreprop_end(Run *run) { run_end(run); }

/* Drill leg after leg: to lengths[k] under forces[k]; where rows[k] is not negative the outputs there become that row
   of the table. Returns how many legs are drilled; if not all, `why` says what the next one met. */
EXPORT Count boreprop_follow(
    Run *run, Count count, const double *lengths, const double *forces, double active_weight_on_bit, const int *rows,
    double *table, char why[MESSAGE]
) {
    Count width = output_count(run->drilling.system.n);
    for (Count k = 0; k < count; k++) {
        Inputs inputs = {.rss_force = forces[k], .active_weight_on_bit = active_weight_on_bit};
        if (run_advance(run, lengths[k], inputs, why) != DONE) return k;
        if (rows[k] >= 0) drilling_outputs(&run->drilling, table + rows[k] * width);
    }
    return count;
}

/* All outputs where the bit is, in the order of the table of quantities; returns how many. */
EXPORT int boreprop_outputs(Run *run, double out[MOST_OUTPUTS]) { return drilling_outputs(&run->drilling, out); }

/* m drilled. */
EXPORT double boreprop_length(const Run *run) { return drilling_length(&run->drilling); }

/* The integrator's own present step: ξ, h, where it ends, the part whose bound it meets there (−1: none), on which
   side; and how many steps were accepted and rejected, and how many bounds met. */
EXPORT void boreprop_step(const Run *run, double numbers[8]) {
    const State *now = &run->drilling.integrator.now;
    const Step *step = &now->step;
    double all[] = {step->xi,   step->h,       step->end,     step->event,
                    step->side, now->accepted, now->rejected, now->events};
    memcpy(numbers, all, sizeof all);
}

EXPORT Count boreprop_state_size(const Run *run) { return drilling_state_size(&run->drilling); }

EXPORT void boreprop_save(Run *run, double *state) { drilling_save(&run->drilling, state); }

EXPORT int boreprop_restore(Run *run, const double *state, Count count, char why[MESSAGE]) {
    return run_restore(run, state, count, why) == DONE;
}
