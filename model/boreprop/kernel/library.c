/* The kernel as a shared library for the binding in Python; boreprop.h says what the functions do. */
#include "boreprop.h"

const char *boreprop_sources_digest(void) { return BOREPROP_SOURCES_DIGEST; }

const char *boreprop_quantities_digest(void) { return QUANTITIES_DIGEST; }

void boreprop_sentence(const Problem *problem, char line[MESSAGE]) { sentence(problem, line); }

/* The structure whose members these are. */
static Structure structure_of(const int members[STRUCTURE_MEMBERS]) {
    Structure made;
    memcpy(&made, members, sizeof made);
    return made;
}

Run *boreprop_start(
    const int structure[STRUCTURE_MEMBERS], const double *parameters, const Options *options, Count count,
    const double *measured_depth, const double *inclination, const double *azimuth, int layers, const double *ground,
    const Inputs *inputs, Problem *problem
) {
    Survey survey = {count, measured_depth, inclination, azimuth};
    Structure made = structure_of(structure);
    System system = system_of(made, parameters);
    Run *run = calloc(1, sizeof *run);
    met(problem, NO_MEMORY, MOST_PIECES, 0.0);
    size_t size = ground ? (size_t)ground_size(layers) * sizeof *ground : 0;
    if (run && ground) run->ground = malloc(size);
    if (run && run->ground) memcpy(run->ground, ground, size);
    if (run && (run->ground || !ground) &&
        run_prepare(run, &system, ground_of(layers, run->ground), *options, problem) == DONE &&
        run_start(run, &survey, *inputs, problem) == DONE)
        return run;
    run_end(run);
    return NULL;
}

void boreprop_end(Run *run) { run_end(run); }

Count boreprop_follow(
    Run *run, Count count, const double *lengths, const Inputs *inputs, const int *which, const int *rows,
    double *table, Count down, Count across, Problem *problem
) {
    for (Count k = 0; k < count; k++) {
        if (run_advance(run, lengths[k], inputs[which[k]], problem) != DONE) return k;
        if (rows[k] >= 0) drilling_outputs(&run->drilling, table + rows[k] * down, across);
    }
    return count;
}

int boreprop_outputs(Run *run, double out[MOST_OUTPUTS]) { return drilling_outputs(&run->drilling, out, 1); }

double boreprop_length(const Run *run) { return drilling_length(&run->drilling); }

int boreprop_change_clearances(Run *run, const double *clearances, Problem *problem) {
    return run_change_clearances(run, clearances, problem) == DONE;
}

int boreprop_step(Run *run, Problem *problem) { return run_step(run, problem) == DONE; }

void boreprop_statistics(const Run *run, double counts[3]) {
    const State *now = &run->drilling.integrator.now;
    counts[0] = now->accepted, counts[1] = now->rejected, counts[2] = now->events;
}

Count boreprop_state_size(const Run *run) { return drilling_state_size(&run->drilling); }

void boreprop_save(const Run *run, double *state) { drilling_save(&run->drilling, state); }

int boreprop_restore(Run *run, const double *state, Count count, Problem *problem) {
    return run_restore(run, state, count, problem) == DONE;
}

#ifndef SPACE
Count boreprop_lie(
    const int structure[STRUCTURE_MEMBERS], const double *parameters, double weight_on_bit, double inclination,
    Count rows, const double *loads, double *answers, Count count, const double *s, double *shapes, Problem *problem
) {
    Structure made = structure_of(structure);
    System system = system_of(made, parameters);
    Lying *bha = calloc(1, sizeof *bha);
    Count k = 0;
    if (!bha) met(problem, NO_MEMORY, MOST_PIECES, 0.0);
    else if (lay(bha, &system, weight_on_bit, inclination, problem)) {
        int width = support_count(bha) + 2;
        Code code = NO_PROBLEM;
        for (; k < rows; k++) {
            code = lie(bha, loads + k * width, answers + k * width, count, s, shapes + k * count);
            if (code) break;
        }
        if (code)
            no_contacts(code, &bha->scaled, bha->modes.axial, bha->F_star, system.relative_tolerance, 0.0, problem);
    }
    free(bha);
    return k;
}
#endif
