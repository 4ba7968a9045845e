/* An instance of the FMU: what it holds, the drilling system behind it, its steps and its states. */
#ifndef BOREPROP_INSTANCE_H
#define BOREPROP_INSTANCE_H

#include "fmi2Functions.h"
#include "packed_case.h"
#include "run.h"
#include "serialized.h"
#include "survey_file.h"

enum { FIXED = 10 }; /* numbers of a state before the values of the variables */
#define MOST_STAIRS 1000.0
static const char *const KIND[] = {"Real", "Integer", "Boolean", "String"};
static const char ERRORS[] = "logStatusError", DISCARDS[] = "logStatusDiscard"; /* categories of the log */

typedef enum { INSTANTIATED = 1, INITIALIZATION = 2, STEPPING = 4, TERMINATED = 8, ANY = 15 } Phase;
typedef enum { STALE, FRESH, MISSING } Outputs; /* MISSING: cannot be computed, and the log has said why */

typedef struct {
    fmi2CallbackFunctions callbacks;
    char *name;
    int logs_discards; /* errors it logs always */
    int has_warned;    /* on stderr, that there is no drilling system */
    Phase phase;
    PackedCase packed;
    double value[MOST_VARIABLES]; /* by value reference; those of outputs as `outputs` says */
    char *survey_file;
    Outputs outputs;
    double derivative[INPUT_COUNT]; /* of the inputs over the next step, 1/s */
    double time, stop;              /* where the last step ended, and where none may end beyond */
    double since, from, rate;       /* since this time, from this drilled length, at this rate of penetration */
    int run_has_inputs;             /* the run has taken over the present inputs */
    int discarded;                  /* the last step was discarded */
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
    const char *category = status == fmi2Discard ? DISCARDS : ERRORS;
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
static Run *new_run(const Variables *all, const double value[MOST_VARIABLES], char why[LINE]) {
    System system = system_of(all->n, value + all->first_parameter);
    Run *run = calloc(1, sizeof *run);
    Problem problem;
    if (!run) explain(why, "run: must fit into the memory");
    else if (run_prepare(run, &system, USUAL_OPTIONS, &problem) == DONE) return run;
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
    c->phase = INSTANTIATED, c->outputs = STALE, c->run_has_inputs = c->discarded = c->has_warned = 0;
    c->time = c->since = c->from = 0.0, c->rate = -1.0, c->stop = INFINITY;
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

/* Make the drilling system; 0 with `why` if that fails. */
static int begin_drilling(Component *c, char why[LINE]) {
    Survey survey = c->packed.survey;
    Inputs inputs = {c->value[IN_RSS_FORCE], 0.0, c->value[IN_ACTIVE_WEIGHT_ON_BIT]};
    Problem problem;
    double *numbers = NULL;
    char fault[LINE];
    if (c->survey_file[0] && !(numbers = read_survey(c->survey_file, &survey, fault)))
        return explain(why, "%.*s (survey_file)", LINE - 32, fault);
    c->run = new_run(&c->packed.variables, c->value, why);
    if (c->run && run_start(c->run, &survey, inputs, &problem) != DONE) {
        tell(&problem, why);
        run_end(c->run);
        c->run = NULL;
    }
    free(numbers);
    return c->run != NULL;
}

/* Whether there is a drilling system. That there is none once the initialization is over is also said on stderr, since
   many hosts show no log. */
static int ready(Component *c, char why[LINE]) {
    char line[2 * LINE];
    if (c->run || begin_drilling(c, why)) return 1;
    if (c->phase == STEPPING && !c->has_warned) {
        snprintf(line, sizeof line, "%s: %s\n", c->name, why);
        fputs(line, stderr);
        c->has_warned = 1;
    }
    return 0;
}

static int check_given(const double input[INPUT_COUNT], Problem *problem) {
    for (int i = 0; i < INPUT_COUNT; i++)
        if (!check_quantity(&INPUT_TABLE[i], 0, input[i], problem)) return 0;
    return 1;
}

/* The outputs of the present hole under the present inputs: 0 with `why` if there are none. */
static int compute(Component *c, char why[LINE]) {
    Inputs inputs = {c->value[IN_RSS_FORCE], 0.0, c->value[IN_ACTIVE_WEIGHT_ON_BIT]};
    double outputs[MOST_OUTPUTS];
    Problem problem;
    if (!ready(c, why)) return 0;
    Drilling *drilling = &c->run->drilling;
    if (!c->run_has_inputs && run_advance(c->run, drilling_length(drilling), inputs, &problem) != DONE)
        return tell(&problem, why);
    c->run_has_inputs = 1;
    int count = drilling_outputs(drilling, outputs);
    if (!check_outputs(c->packed.variables.n, outputs, &problem)) return tell(&problem, why);
    memcpy(c->value + c->packed.variables.first_output, outputs, (size_t)count * sizeof *outputs);
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

/* Drill to a length while the inputs go from their present values to those at its end. The force is linear in the
   length. The kernel keeps the weight on bit constant over a stretch, so it goes up or down in stairs of equal length,
   each by a thousandth of its larger value at most. If one stair fails, nothing has moved. */
static int drill_on(Component *c, double to, const double end[INPUT_COUNT], char why[LINE]) {
    Drilling *drilling = &c->run->drilling;
    double from = drilling_length(drilling), force = c->value[IN_RSS_FORCE], weight = c->value[IN_ACTIVE_WEIGHT_ON_BIT];
    double slope = to > from ? (end[IN_RSS_FORCE] - force) / (to - from) : 0.0,
           rise = end[IN_ACTIVE_WEIGHT_ON_BIT] - weight;
    int stairs = to > from ? (int)ceil(MOST_STAIRS * (fabs(rise) / larger(weight, weight + rise))) : 1;
    int stair = 0, done = 1;
    Count size = drilling_state_size(drilling);
    double *before = NULL, accepted = drilling->integrator.now.accepted;
    Problem problem;
    if (!check_finite(Q_RSS_FORCE_SLOPE, 0, slope, &problem)) return tell(&problem, why);
    if (stairs > 1) {
        before = malloc((size_t)size * sizeof *before);
        if (!before) return explain(why, "step: must fit into the memory");
        drilling_save(drilling, before);
    } else stairs = 1;
    for (; done && stair < stairs; stair++) {
        double at = drilling_length(drilling);
        Inputs inputs = {force + slope * (at - from), slope, weight + rise * (stair + 0.5) / stairs};
        double next = stair + 1 < stairs ? from + (to - from) * (stair + 1) / stairs : to;
        done = run_advance(c->run, next, inputs, &problem) == DONE;
        if (done && drilling->integrator.now.accepted - accepted > USUAL_OPTIONS.most_steps)
            done = too_many(&drilling->integrator, &problem) == DONE;
    }
    if (!done) tell(&problem, why);
    if (!done && before) drilling_return(drilling, before);
    free(before);
    if (done) c->run_has_inputs = rise == 0.0 && (to > from || end[IN_RSS_FORCE] == force);
    return done;
}

/* Whether a step may be taken to these inputs at its end, before the run is looked at. */
static fmi2Status check_step(
    const Component *c, double time, double size, const double end[INPUT_COUNT], char why[LINE]
) {
    double late = c->stop + larger(1e-12 * fabs(c->stop), 1e-3 * size); /* a host may add up rounding errors */
    Problem problem;
    if (!check_finite(Q_CURRENT_TIME, 0, time, &problem) || !check_positive(Q_STEP_SIZE, size, &problem)) {
        tell(&problem, why);
        return fmi2Discard;
    }
    if (time + size > late) {
        wrong(&problem, TOO_LARGE, Q_STEP_END, 0, time + size, c->stop);
        tell(&problem, why);
        return fmi2Error;
    }
    int now_good = check_given(c->value, &problem);
    if (now_good && check_given(end, &problem)) return fmi2OK;
    tell(&problem, why);
    if (now_good) strcat(why, " at the end of the step");
    return fmi2Discard;
}

/* One communication step. The length counts from an anchor, so that rounding does not add up from step to step. */
static fmi2Status step(Component *c, double time, double size, char why[LINE]) {
    double end[INPUT_COUNT], *value = c->value, start_rate = value[IN_RATE_OF_PENETRATION];
    double since = c->since, from = c->from;
    Problem problem;
    for (int i = 0; i < INPUT_COUNT; i++) end[i] = value[i] + c->derivative[i] * size;
    double *end_rate = &end[IN_RATE_OF_PENETRATION];
    if (*end_rate < 0.0 && *end_rate > -1e-12 * start_rate) *end_rate = 0.0; /* rounding */
    fmi2Status status = check_step(c, time, size, end, why);
    if (status != fmi2OK) return status;
    if (!ready(c, why)) return fmi2Error;
    double here = drilling_length(&c->run->drilling);
    double close = larger(1e-12 * larger(fabs(time), fabs(c->time)), 1e-9 * size);
    if (start_rate != c->rate || *end_rate != start_rate || fabs(time - c->time) > close) since = time, from = here;
    double length = from + start_rate * (time + size - since) + (*end_rate - start_rate) * size / 2;
    if (!check_finite(Q_DRILLED_LENGTH, 0, length, &problem)) {
        tell(&problem, why);
        return fmi2Discard;
    }
    if (!drill_on(c, larger(length, here), end, why)) return fmi2Discard;
    c->time = time + size, c->since = since, c->from = from;
    c->rate = *end_rate == start_rate ? start_rate : -1.0; /* a ramp is no anchor */
    memcpy(value, end, sizeof end);
    memset(c->derivative, 0, sizeof c->derivative);
    c->outputs = STALE;
    return fmi2OK;
}

/* States */

static fmi2Status save(Component *c, Saved *saved) {
    Count count = c->run ? drilling_state_size(&c->run->drilling) : 0;
    const Variables *all = &c->packed.variables;
    size_t text = strlen(c->survey_file), size = ((size_t)(count + all->count) + FIXED) * 8 + text;
    unsigned char *bytes = malloc(size), *to = bytes;
    double *numbers = malloc((size_t)(count + 1) * sizeof *numbers);
    double fixed[FIXED] = {c->phase,          c->time,          c->since,         c->from,          c->rate,
                           c->run_has_inputs, c->derivative[0], c->derivative[1], c->derivative[2], (double)text};
    if (bytes && numbers) {
        for (int i = 0; i < FIXED; i++) to = put_double(to, fixed[i]);
        for (int i = 0; i < all->count; i++) to = put_double(to, all->at[i].role == OUTPUT ? 0.0 : c->value[i]);
        if (c->run) drilling_save(&c->run->drilling, numbers);
        for (Count i = 0; i < count; i++) to = put_double(to, numbers[i]);
        memcpy(to, c->survey_file, text);
        free(saved->bytes);
        saved->bytes = bytes, saved->size = size;
    } else free(bytes);
    free(numbers);
    return bytes && numbers ? fmi2OK : fail(c, fmi2Error, "state: must fit into the memory");
}

/* Go back to a state, or keep everything as it is, with `why`. */
static int restore(Component *c, const Saved *saved, char why[LINE]) {
    const Variables *all = &c->packed.variables;
    const unsigned char *from = saved->bytes;
    size_t size = saved->size, least = (size_t)(FIXED + all->count) * 8;
    double fixed[FIXED], value[MOST_VARIABLES] = {0};
    Problem problem;
    if (size < least) return explain(why, "state: must be one of this FMU, got one of %lu bytes", (unsigned long)size);
    for (int i = 0; i < FIXED; i++) fixed[i] = get_double(&from);
    for (int i = 0; i < all->count; i++) value[i] = get_double(&from);
    double text = fixed[FIXED - 1];
    int phase = fixed[0] >= 0.0 && fixed[0] <= 8.0 ? (int)fixed[0] : 0;
    if (!(phase == INSTANTIATED || phase == INITIALIZATION || phase == STEPPING || phase == TERMINATED) ||
        !(text >= 0.0 && text <= (double)(size - least)) || (size - (size_t)text) % 8)
        return explain(why, "state: must be one of this FMU, got one with an impossible phase or length");
    for (int i = 1; i < FIXED; i++)
        if (!check_finite(Q_STATE, 0, fixed[i], &problem)) return tell(&problem, why);
    Count count = (Count)((size - least - (size_t)text) / 8);
    char *survey_file = calloc((size_t)text + 1, 1);
    double *numbers = malloc((size_t)(count + 1) * sizeof *numbers);
    Run *run = NULL;
    if (survey_file && numbers) {
        for (Count i = 0; i < count; i++) numbers[i] = get_double(&from);
        memcpy(survey_file, from, (size_t)text);
        if (!is_utf8(survey_file)) {
            explain(why, "state: must be one of this FMU, got one with text that is not UTF-8");
            count = -1;
        }
        if (count > 0) run = new_run(all, value, why);
        if (run && run_restore(run, numbers, count, &problem) != DONE) {
            tell(&problem, why);
            run_end(run);
            run = NULL;
        }
    } else explain(why, "state: must fit into the memory");
    int whole = survey_file && numbers && (run || !count);
    free(numbers);
    if (!whole) {
        free(survey_file);
        return 0;
    }
    run_end(c->run);
    free(c->survey_file);
    c->run = run, c->survey_file = survey_file, c->phase = (Phase)phase, c->outputs = STALE, c->discarded = 0;
    c->time = fixed[1], c->since = fixed[2], c->from = fixed[3], c->rate = fixed[4],
    c->run_has_inputs = fixed[5] != 0.0;
    memcpy(c->derivative, fixed + 6, sizeof c->derivative);
    memcpy(c->value, value, sizeof value);
    return 1;
}

#endif
