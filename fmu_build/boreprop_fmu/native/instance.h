/* An instance of the FMU: what it holds, and the drilling system behind it. */
#ifndef BOREPROP_INSTANCE_H
#define BOREPROP_INSTANCE_H

#include "fmi2Functions.h"
#include "packed_case.h"
#include "run.h"
#include "survey_file.h"

static const char *const KIND[] = {"Real", "Integer", "Boolean", "String"};
#define TIGHTEST 1e-12 /* tolerance that a host may choose */
#define LOOSEST 1e-5   /* some choose 1e-3 for every FMU, which is too coarse for a hole */
static const char ERRORS[] = "logStatusError", DISCARDS[] = "logStatusDiscard", WARNINGS[] = "logStatusWarning";

typedef enum { INSTANTIATED = 1, INITIALIZATION = 2, STEPPING = 4, TERMINATED = 8, ANY = 15 } Phase;
typedef enum { STALE, FRESH, MISSING } Outputs; /* MISSING: cannot be computed, and the log has said why */

typedef struct {
    fmi2CallbackFunctions callbacks;
    char *name;
    int logs_discards, logs_warnings; /* errors it logs always */
    int has_warned;                   /* on stderr, of what stopped it */
    int has_tolerance;                /* the parameter for it has been set */
    Phase phase;
    PackedCase packed;
    double value[MOST_VARIABLES]; /* by value reference; those of outputs as `outputs` says */
    char *survey_file;
    Outputs outputs;
    double derivative[INPUT_COUNT]; /* of the inputs over the next step, 1/s */
    double time, stop;              /* where the last step ended, and where none may end beyond */
    double since, from, rate;       /* since this time, from this drilled length, at this rate of penetration */
    double weight;                  /* on the bit, the last that drilled; at the start that of the case */
    int run_has_inputs;             /* the run has taken over the present inputs */
    int discarded;                  /* the last step was discarded */
    double next_look;               /* from which drilled length on: whether the axis of the BHA leaves the hole */
    Run *run;                       /* made when it is first needed */
} Component;

/* Messages */

static void log_line(const fmi2CallbackFunctions *callbacks, const char *name, fmi2Status status, const char *line) {
    char format[2 * LINE], *to = format;
    for (; *line; line++) {
        if (*line == '%') *to++ = '%'; /* a logger formats its message like printf */
        if (*line == '#') *to++ = '#'; /* and puts names in the place of #r7# */
        *to++ = *line;
    }
    *to = '\0';
    const char *category = status == fmi2Discard ? DISCARDS : status == fmi2Warning ? WARNINGS : ERRORS;
    if (callbacks->logger) callbacks->logger(callbacks->componentEnvironment, name, status, category, format);
}

static fmi2Status fail(const Component *c, fmi2Status status, const char *why) {
    if (status == fmi2Error || c->logs_discards) log_line(&c->callbacks, c->name, status, why);
    return status;
}

static fmi2Status fail_by(const Component *c, fmi2Status status, const Problem *problem) {
    char why[LINE];
    tell(problem, why);
    return fail(c, status, why);
}

/* The drilling system */

/* A drilling system that has not begun; NULL with `why` if the parameters are bad. */
static Run *new_run(const PackedCase *packed, const double value[MOST_VARIABLES], char why[LINE]) {
    const Variables *all = &packed->variables;
    System system = system_of(all->structure, value + all->first_parameter);
    Run *run = calloc(1, sizeof *run);
    Problem problem;
    if (!run) explain(why, "run: must fit into the memory");
    else if (run_prepare(run, &system, packed->ground, USUAL_OPTIONS, &problem) == DONE) return run;
    else tell(&problem, why);
    run_end(run);
    return NULL;
}

static char *copy(const char *text) {
    size_t size = strlen(text) + 1;
    char *own = malloc(size);
    return own ? memcpy(own, text, size) : NULL;
}

/* Put an instance into the condition that it has after fmi2Instantiate; 0 if the memory does not suffice. */
static int start_over(Component *c) {
    char *none = copy("");
    if (!none) return 0;
    run_end(c->run);
    free(c->survey_file);
    c->run = NULL, c->survey_file = none;
    c->phase = INSTANTIATED, c->outputs = STALE, c->run_has_inputs = c->discarded = 0;
    c->has_warned = c->has_tolerance = 0;
    c->next_look = 0.0;
    c->time = c->since = c->from = 0.0, c->rate = -1.0, c->stop = INFINITY;
    c->weight = c->packed.start[IN_ACTIVE_WEIGHT_ON_BIT];
    memset(c->derivative, 0, sizeof c->derivative);
    memcpy(c->value, c->packed.start, sizeof c->value);
    return 1;
}

/* To be called after a variable has got another value: outputs, and before the start the run, are out of date. */
static void changed(Component *c) {
    c->outputs = STALE, c->run_has_inputs = 0;
    if (c->phase == STEPPING) return;
    run_end(c->run);
    c->run = NULL;
}

/* Whether inputs are those of a bit off bottom, as while a pipe is connected: nothing moves. */
static int are_off_bottom(const double input[INPUT_COUNT]) {
    return input[IN_ACTIVE_WEIGHT_ON_BIT] == 0.0 && input[IN_RATE_OF_PENETRATION] == 0.0;
}

/* The inputs that are held along a communication step: bit and rock, the whole weight on bit, and the toolface. */
static Inputs held_inputs(const Component *c) {
    Inputs inputs = {
        .lateral_steering_resistance = c->value[IN_LATERAL_STEERING_RESISTANCE],
        .angular_steering_resistance = c->value[IN_ANGULAR_STEERING_RESISTANCE],
        .bit_tilt_limit = c->value[IN_BIT_TILT_LIMIT],
        .weight_on_bit = c->packed.variables.structure.axial ? c->value[IN_WEIGHT_ON_BIT] : 0.0
    };
    if (c->packed.variables.structure.space) {
        const int *input = c->packed.variables.input;
        inputs.bit_walk_angle = c->value[input[IN_BIT_WALK_ANGLE]];
        inputs.rss_toolface = c->value[input[IN_RSS_TOOLFACE]];
        inputs.toolface_reference = c->value[input[IN_TOOLFACE_REFERENCE]];
    }
    return inputs;
}

/* Whether an input has a value for which a layer stands in, unless it changes along the way. */
static int is_layers_own(const Component *c, int input, double value) {
    const Drilling *drilling = &c->run->drilling;
    int rock = input - IN_LATERAL_STEERING_RESISTANCE;
    return rock >= 0 && rock < ROCK && stands_in(&drilling->ground, drilling->integrator.now.layer, rock, value);
}

/* What the run is given: without weight there is no ηΠ, and the last one that drilled stands for it. */
static Inputs present_inputs(const Component *c) {
    double weight = c->value[IN_ACTIVE_WEIGHT_ON_BIT];
    Inputs inputs = held_inputs(c);
    inputs.rss_force = c->value[IN_RSS_FORCE], inputs.active_weight_on_bit = weight == 0.0 ? c->weight : weight;
    return inputs;
}

/* Make the drilling system; 0 with `why` if that fails. */
static int begin_drilling(Component *c, char why[LINE]) {
    Survey survey = c->packed.survey;
    Problem problem;
    double *numbers = NULL;
    char fault[LINE];
    if (c->survey_file[0] && !(numbers = read_survey(c->survey_file, &survey, fault)))
        return explain(why, "%.*s (survey_file)", LINE - 32, fault);
    c->run = new_run(&c->packed, c->value, why);
    if (c->run && run_start(c->run, &survey, present_inputs(c), &problem) != DONE) {
        tell(&problem, why);
        run_end(c->run);
        c->run = NULL;
    }
    free(numbers);
    return c->run != NULL;
}

/* Say on stderr what stops the instance, once, since many hosts show no log. */
static void warn(Component *c, const char *why) {
    char line[2 * LINE];
    if (c->has_warned) return;
    snprintf(line, sizeof line, "%s: %s\n", c->name, why);
    fputs(line, stderr);
    c->has_warned = 1;
}

/* Whether there is a drilling system. That there is none once the initialization is over is also said on stderr. */
static int ready(Component *c, char why[LINE]) {
    if (c->run || begin_drilling(c, why)) return 1;
    if (c->phase == STEPPING) warn(c, why);
    return 0;
}

/* What a host says of the experiment. Its tolerance is taken if the parameter for it has not been set. */
static fmi2Status set_up(Component *c, const double *tolerance, double start, double stop) {
    int reference = c->packed.variables.relative_tolerance;
    Problem problem;
    char why[LINE];
    if (!check_finite(Q_START_TIME, 0, start, &problem)) return fail_by(c, fmi2Error, &problem);
    c->time = start, c->stop = stop;
    if (!tolerance || c->has_tolerance) return fmi2OK;
    if (*tolerance >= TIGHTEST && *tolerance <= LOOSEST) {
        c->value[reference] = *tolerance;
        changed(c);
    } else if (c->logs_warnings) {
        char got[32], own[32];
        represent(*tolerance, got), represent(c->value[reference], own);
        explain(why, "tolerance: must be %g to %g, got %s; relative_tolerance stays %s", TIGHTEST, LOOSEST, got, own);
        log_line(&c->callbacks, c->name, fmi2Warning, why);
    }
    return fmi2OK;
}

/* Whether inputs are good: 0 with `why` if not. */
static int check_given(const Component *c, const double input[INPUT_COUNT], char why[LINE]) {
    Problem problem;
    for (int i = 0; i < INPUT_COUNT; i++)
        if (value_count(INPUT_TABLE[i].size, c->packed.variables.structure) &&
            !check_quantity(&INPUT_TABLE[i], 0, input[c->packed.variables.input[i]], &problem)) {
            if (i == IN_ACTIVE_WEIGHT_ON_BIT && are_off_bottom(input)) continue;
            if (i != IN_ACTIVE_WEIGHT_ON_BIT || input[i] != 0.0) return tell(&problem, why);
            return explain(why, "active_weight_on_bit: must be > 0 where rate_of_penetration is > 0, got 0.0");
        }
    return 1;
}

/* The state of the run, to go back to by `drilling_return`; NULL with `why` if it does not fit into the memory. */
static double *kept_state(const Drilling *drilling, char why[LINE]) {
    double *state = malloc((size_t)drilling_state_size(drilling) * sizeof *state);
    if (state) drilling_save(drilling, state);
    else explain(why, "step: must fit into the memory");
    return state;
}

/* Let the run drill on to a length under inputs, with the clearances as they are set; 0 with `why` if that fails, and
   nothing has moved. */
static int advance(Component *c, double to, Inputs inputs, char why[LINE]) {
    Drilling *drilling = &c->run->drilling;
    const double *clearances = c->value + c->packed.variables.first_clearance;
    double *before = NULL;
    Problem problem;
    Status status = DONE;
    if (!c->run_has_inputs && has_other_clearances(drilling, clearances)) {
        if (!(before = kept_state(drilling, why))) return 0;
        status = run_change_clearances(c->run, clearances, &problem);
    }
    if (status == DONE) status = run_advance(c->run, to, inputs, &problem);
    if (status != DONE && before) drilling_return(drilling, before);
    free(before);
    return status == DONE || tell(&problem, why);
}

/* Give the run, where it is, the present inputs; 0 with `why` if that fails. Off bottom for a moment only: `give_back` is
   to be called next, and it goes on as if it had never stopped. */
static int take_inputs(Component *c, double **before, char why[LINE]) {
    *before = NULL;
    if (!ready(c, why)) return 0;
    Drilling *drilling = &c->run->drilling;
    int off_bottom = c->value[IN_ACTIVE_WEIGHT_ON_BIT] == 0.0;
    if (off_bottom && !(*before = kept_state(drilling, why))) return 0;
    if (c->run_has_inputs || advance(c, drilling_length(drilling), present_inputs(c), why)) {
        c->run_has_inputs = !off_bottom;
        return 1;
    }
    free(*before); /* nothing has moved */
    *before = NULL;
    return 0;
}

static void give_back(Component *c, double *before) {
    if (before) drilling_return(&c->run->drilling, before);
    free(before);
}

/* The outputs of the present hole under the present inputs: 0 with `why` if there are none. */
static int compute(Component *c, char why[LINE]) {
    const Variables *all = &c->packed.variables;
    double outputs[MOST_OUTPUTS] = {0.0}, *before;
    Problem problem;
    if (!take_inputs(c, &before, why)) return 0;
    int count = drilling_outputs(&c->run->drilling, outputs, 1);
    give_back(c, before);
    if (!check_outputs(&c->run->drilling, outputs, &problem)) return tell(&problem, why);
    memcpy(c->value + all->first_output, outputs, (size_t)count * sizeof *outputs);
    if (c->value[IN_ACTIVE_WEIGHT_ON_BIT] == 0.0) c->value[all->eta_pi] = 0.0;
    return 1;
}

/* Whether there are outputs; they are computed now if need be. */
static int refreshed(Component *c) {
    char why[LINE];
    if (c->outputs == STALE) {
        c->outputs = compute(c, why) ? FRESH : MISSING;
        if (c->outputs == MISSING) fail(c, fmi2Error, why);
    }
    return c->outputs == FRESH;
}

#endif
