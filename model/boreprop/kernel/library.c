/* The kernel as a shared library, for the binding in Python: boreprop.h says what the functions do. */
#include "boreprop.h"

const char *boreprop_sources_digest(void) { return BOREPROP_SOURCES_DIGEST; }

const char *boreprop_quantities_digest(void) { return QUANTITIES_DIGEST; }

Run *boreprop_start(
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

void boreprop_end(Run *run) { run_end(run); }

Count boreprop_follow(
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

int boreprop_outputs(Run *run, double out[MOST_OUTPUTS]) { return drilling_outputs(&run->drilling, out); }

double boreprop_length(const Run *run) { return drilling_length(&run->drilling); }

void boreprop_step(const Run *run, double numbers[8]) {
    const State *now = &run->drilling.integrator.now;
    const Step *step = &now->step;
    double all[] = {step->xi, step->h, step->end, step->event, step->side, now->accepted, now->rejected, now->events};
    memcpy(numbers, all, sizeof all);
}

Count boreprop_state_size(const Run *run) { return drilling_state_size(&run->drilling); }

void boreprop_save(const Run *run, double *state) { drilling_save(&run->drilling, state); }

int boreprop_restore(Run *run, const double *state, Count count, char why[MESSAGE]) {
    return run_restore(run, state, count, why) == DONE;
}
