/* The states of an instance: saved, and gone back to. */
#ifndef BOREPROP_STATES_H
#define BOREPROP_STATES_H

#include "instance.h"
#include "serialized.h"

enum { FIXED = 9 + INPUT_COUNT }; /* numbers of a state before the values of the variables */

static fmi2Status save(Component *c, Saved *saved) {
    Count count = c->run ? drilling_state_size(&c->run->drilling) : 0;
    const Variables *all = &c->packed.variables;
    size_t text = strlen(c->survey_file), size = ((size_t)(count + all->count) + FIXED) * 8 + text;
    unsigned char *bytes = malloc(size), *to = bytes;
    double *numbers = malloc((size_t)(count + 1) * sizeof *numbers);
    double fixed[FIXED] = {c->phase,          c->time,   c->since,         c->from,     c->rate,
                           c->run_has_inputs, c->weight, c->has_tolerance, (double)text};
    memcpy(fixed + FIXED - INPUT_COUNT, c->derivative, sizeof c->derivative);
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
    for (int i = 0; i < all->count; i++) {
        value[i] = get_double(&from);
        if (!is_value_of(all->at[i].kind, value[i]))
            return explain(why, "state: must be one of this FMU, got one whose %s is no Integer", all->at[i].name);
    }
    double text = fixed[8];
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
        if (count > 0) run = new_run(&c->packed, value, why);
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
    c->weight = fixed[6], c->has_tolerance = fixed[7] != 0.0;
    memcpy(c->derivative, fixed + FIXED - INPUT_COUNT, sizeof c->derivative);
    memcpy(c->value, value, sizeof value);
    if (isfinite(c->next_look)) c->next_look = 0.0; /* it may be another hole */
    return 1;
}

/* Write a state, sealed, into memory of the host. */
static fmi2Status serialize(const Component *c, const Saved *state, fmi2Byte bytes[], size_t size) {
    char why[LINE], line[SEAL + 1];
    if (size < SEAL + state->size) {
        explain(why, "size: must be at least %lu, got %lu", (unsigned long)(SEAL + state->size), (unsigned long)size);
        return fail(c, fmi2Error, why);
    }
    seal(c->packed.guid, state->bytes, state->size, line);
    memcpy(bytes, line, SEAL);
    memcpy(bytes + SEAL, state->bytes, state->size);
    return fmi2OK;
}

/* A state that was written so; NULL with `why` if it is not one of this FMU. */
static Saved *deserialize(const Component *c, const fmi2Byte bytes[], size_t size, char why[LINE]) {
    if (!is_sealed((const unsigned char *)bytes, size, c->packed.guid, why)) return NULL;
    Saved *state = malloc(sizeof *state);
    if (state) state->size = size - SEAL, state->bytes = malloc(size);
    if (state && state->bytes) {
        memcpy(state->bytes, bytes + SEAL, state->size);
        return state;
    }
    free(state);
    explain(why, "state: must fit into the memory");
    return NULL;
}

#endif
