/* A drilling run in SI units: the shell around the propagation. Nothing here allocates: the caller gives the memory. */
#ifndef BOREPROP_DRILLING_H
#define BOREPROP_DRILLING_H

#include "propagation.h"

enum { LEAST_CAPACITY = 1024 };

/* A borehole as it is drilled, from the end of the survey on. */
typedef struct {
    System system;
    double drilled_length; /* m */
    Propagation propagation;
} Drilling;

static inline int check_inputs(Inputs inputs, char why[MESSAGE]) {
    return check_quantity(&INPUT_TABLE[IN_RSS_FORCE], 0, inputs.rss_force, why) &&
           check_finite("rss_force_slope", inputs.rss_force_slope, why) &&
           check_quantity(&INPUT_TABLE[IN_ACTIVE_WEIGHT_ON_BIT], 0, inputs.active_weight_on_bit, why);
}

/* The dimensionless inputs; 0, with `why`, if they are bad, in N or over F*. */
static inline int scale_inputs(const System *system, Inputs inputs, ScaledInputs *scaled, char why[MESSAGE]) {
    double F_star = force_scale(system);
    scaled->F_rss = inputs.rss_force / F_star;
    scaled->F_rss_slope = inputs.rss_force_slope * length_scale(system) / F_star;
    scaled->eta_pi = eta_pi(system, inputs.active_weight_on_bit);
    return check_inputs(inputs, why) && check_finite("rss_force / F*", scaled->F_rss, why) &&
           check_finite("rss_force_slope / F*", scaled->F_rss_slope, why) &&
           check_positive("eta_pi", scaled->eta_pi, why) && check_finite("1 / eta_pi", 1 / scaled->eta_pi, why);
}

/* Capacity, in pieces of hole, that a run under ordinary inputs needs. */
static inline Count drilling_capacity(const System *system, const Survey *survey) {
    double l1 = length_scale(system), reach = LOOK_BACK + system->stabilizer_position[system->n - 1] / l1;
    Count count, first = first_station(survey, l1, reach, &count), capacity = LEAST_CAPACITY;
    while (capacity < 4 * (count - first)) capacity *= 2;
    return capacity;
}

/* Bytes for a capacity (a power of two). */
static inline size_t drilling_memory(Count capacity) { return (size_t)capacity * (sizeof(Piece) + sizeof(Kink)); }

static inline Hole lay_out(void *memory, Count capacity) {
    Hole hole = {(Piece *)memory, (Kink *)(void *)((Piece *)memory + capacity), capacity};
    return hole;
}

/* A drilling system that has not begun: `drilling_start` or `drilling_restore` is next. The memory must live on. */
static inline Status drilling_prepare(
    Drilling *d, const System *system, void *memory, Count capacity, char why[MESSAGE]
) {
    if (!check_system(system, why)) return FAILED;
    if (!check_positive("F*", force_scale(system), why)) return FAILED;
    Scaled scaled = scale(system);
    if (!check_finite("s_n / l_1", scaled.s[scaled.n - 1], why) || !check_finite("w l_1 / F*", scaled.w, why) ||
        !check_positive("epsilon", scaled.epsilon, why) || !check_finite("1 / epsilon", 1 / scaled.epsilon, why))
        return FAILED;
    d->system = *system;
    d->drilled_length = 0.0;
    prepare(&d->propagation, &scaled, length_scale(system), system->relative_tolerance, lay_out(memory, capacity));
    return DONE;
}

/* Start at the end of the survey, which need not live on. */
static inline Status drilling_start(Drilling *d, const Survey *survey, Inputs inputs, char why[MESSAGE]) {
    ScaledInputs scaled_inputs;
    if (!check_survey(survey, why)) return FAILED;
    if (!scale_inputs(&d->system, inputs, &scaled_inputs, why)) return FAILED;
    if (d->propagation.hole.capacity < drilling_capacity(&d->system, survey)) return FULL;
    return begin(&d->propagation, survey, scaled_inputs, why);
}

/* Drill on to a length, m from the start, under inputs from here; where the bit is, only they are taken over.
   After FULL: `drilling_move`, and the same call again, which goes on; or `drilling_cancel`, and nothing has moved. */
static inline Status drilling_advance(Drilling *d, double drilled_length, Inputs inputs, char why[MESSAGE]) {
    ScaledInputs scaled_inputs;
    if (!scale_inputs(&d->system, inputs, &scaled_inputs, why)) return FAILED;
    if (!check_at_least("drilled_length", drilled_length, d->drilled_length, why)) return FAILED;
    double xi = drilled_length / length_scale(&d->system);
    Status status = drill(&d->propagation, xi, scaled_inputs, why);
    if (status == DONE) d->drilled_length = drilled_length;
    return status;
}

static inline void drilling_cancel(Drilling *d) { go_back(&d->propagation); }

/* What the outputs follow from: the state where the bit is. */
typedef struct {
    double l1, F_star, theta, Theta, psi, F_0, F[MAX_STABILIZERS], x, z, earlier; /* earlier: Θ one ℓ₁ ago */
    Loads loads;
    const Mode *mode;
} Present;

static inline Present present(Drilling *d) {
    Propagation *p = &d->propagation;
    const State *now = &p->now;
    double Y;
    Present at;
    at.l1 = length_scale(&d->system), at.F_star = force_scale(&d->system);
    at.earlier = earlier_inclination(p, now->xi - 1.0);
    step_state(&now->step, now->xi, &at.theta, &Y);
    at.loads = present_loads(p);
    at.mode = settle(&p->modes, &at.loads, now->contact);
    at.F_0 = row_value(&at.mode->F_0, &at.loads, p->scaled.n);
    for (int i = 0; i < p->scaled.n - 1; i++) at.F[i] = row_value(&at.mode->F[i], &at.loads, p->scaled.n);
    at.psi = bit_tilt(at.F_0, now->inputs.eta_pi, p->scaled.psi_star);
    at.Theta = at.theta - at.psi;
    position_at(now, now->xi, &at.x, &at.z);
    return at;
}

/* One output; of several of a kind the one with this index. A compiler refuses it where one of the table is missing. */
static inline double output(const Drilling *d, const Present *at, Output which, int i) {
    const Scaled *scaled = &d->propagation.scaled;
    const Loads *loads = &at->loads;
    const ScaledInputs *inputs = &d->propagation.now.inputs;
    double l1 = at->l1, F_star = at->F_star;
    int n = scaled->n;
    switch (which) {
    case OUT_DRILLED_LENGTH: return d->drilled_length;
    case OUT_BIT_INCLINATION: return at->theta;
    case OUT_BOREHOLE_INCLINATION: return at->Theta;
    case OUT_BIT_TILT: return at->psi;
    case OUT_AVERAGE_INCLINATION: /* λ_i (⟨Θ⟩_i − θ) = e_i − e_{i−1} */
        return at->theta + (loads->e[i] - (i ? loads->e[i - 1] : 0.0)) / lambda_(scaled, i);
    case OUT_STABILIZER_DEFLECTION: return row_value(&at->mode->delta[i], loads, n) * l1;
    case OUT_STABILIZER_FORCE: return at->F[i] * F_star;
    case OUT_STABILIZER_CONTACT: return wall(at->F[i]);
    case OUT_BIT_TILT_SATURATION: return left(at->F_0 / inputs->eta_pi, -scaled->psi_star, scaled->psi_star, ROUNDING);
    case OUT_BIT_LATERAL_FORCE: return at->F_0 * F_star;
    case OUT_BIT_MOMENT: return -row_value(&at->mode->M, loads, n) * F_star * l1;
    case OUT_BOREHOLE_CURVATURE: return (at->Theta - at->earlier) / l1;
    case OUT_DISPLACEMENT: return at->x * l1;
    case OUT_TRUE_VERTICAL_DEPTH: return at->z * l1;
    case OUT_ETA_PI: return inputs->eta_pi;
    }
    return NAN;
}

/* How many values `drilling_outputs` writes. */
static inline int output_count(int n) {
    int count = 0;
    for (int k = 0; k < OUTPUT_COUNT; k++) count += value_count(OUTPUT_SIZE[k], n);
    return count;
}

/* Every output of the table of quantities where the bit is, in its order; returns how many values. */
static inline int drilling_outputs(Drilling *d, double out[MOST_OUTPUTS]) {
    Present at = present(d);
    double *next = out;
    for (int k = 0; k < OUTPUT_COUNT; k++)
        for (int i = 0; i < value_count(OUTPUT_SIZE[k], d->system.n); i++) *next++ = output(d, &at, (Output)k, i);
    return (int)(next - out);
}

/* A state as numbers, written to or read from a tape: first the whole ones, then the others of which there is a fixed
   count, then the pieces of the hole and the kinks. */
typedef struct {
    double *at;
    int reading;
} Tape;

enum { WHOLE_NUMBERS = 5 + 2 * MAX_STABILIZERS, FIXED_NUMBERS = WHOLE_NUMBERS + 28 };
enum { NUMBERS_OF_PIECE = 2 * S + 7, NUMBERS_OF_KINK = 3 };
enum { AT_LENGTH = WHOLE_NUMBERS + 1, AT_XI, AT_ETA_PI = AT_XI + 3, AT_INPUTS_XI, AT_STEP = AT_INPUTS_XI + 4 };
enum { AT_Y = AT_STEP + S + 3, AT_STEP_END = AT_Y + S + 1 }; /* places of some of the fixed numbers */

static inline void pass(Tape *tape, int count, double *values) {
    memcpy(tape->reading ? values : tape->at, tape->reading ? tape->at : values, (size_t)count * sizeof *values);
    tape->at += count;
}

static inline Count pass_whole(Tape *tape, Count value) {
    double number = (double)value;
    pass(tape, 1, &number);
    return (Count)number;
}

static inline void pass_state(Tape *tape, Drilling *d) {
    Propagation *p = &d->propagation;
    State *now = &p->now;
    Step *step = &now->step;
    Count first_kink = now->ahead[p->scaled.n - 1];
    if (tape->reading) now->pieces.first = first_kink = 0;
    now->pieces.end = now->pieces.first + pass_whole(tape, now->pieces.end - now->pieces.first);
    now->kinks_end = first_kink + pass_whole(tape, now->kinks_end - first_kink);
    for (int i = 0; i < MAX_STABILIZERS; i++) {
        now->ahead[i] = first_kink + pass_whole(tape, i < p->scaled.n ? now->ahead[i] - first_kink : 0);
        now->contact.of[i] = (signed char)pass_whole(tape, now->contact.of[i]);
    }
    now->tilt = (int)pass_whole(tape, now->tilt);
    step->event = (int)pass_whole(tape, step->event);
    step->side = (int)pass_whole(tape, step->side);
    pass(tape, 1, &step->next_h); /* the one that may be infinite */
    pass(tape, 1, &d->drilled_length);
    pass(tape, 1, &now->xi);
    pass(tape, 1, &now->inputs.F_rss);
    pass(tape, 1, &now->inputs.F_rss_slope);
    pass(tape, 1, &now->inputs.eta_pi);
    pass(tape, 1, &now->inputs_xi);
    pass(tape, 2, now->path);
    pass(tape, 1, &now->origin);
    pass(tape, 1, &step->xi);
    pass(tape, 1, &step->h);
    pass(tape, S + 1, step->theta);
    pass(tape, S + 1, step->Y);
    pass(tape, 1, &step->end);
    pass(tape, 1, &now->accepted);
    pass(tape, 1, &now->rejected);
    pass(tape, 1, &now->events);
    for (Count k = now->pieces.first; k < now->pieces.end; k++) {
        Piece *at = piece(&p->hole, k);
        pass(tape, 1, &at->start), pass(tape, 1, &at->rate), pass(tape, S + 1, at->c), pass(tape, S + 1, at->theta);
        pass(tape, 1, &at->inputs.F_rss), pass(tape, 1, &at->inputs.F_rss_slope), pass(tape, 1, &at->inputs.eta_pi);
    }
    for (Count k = first_kink; k < now->kinks_end; k++) {
        Kink *at = kink(&p->hole, k);
        pass(tape, 1, &at->xi), pass(tape, 1, &at->jump), pass(tape, 1, &at->order);
    }
}

/* How many numbers `drilling_save` writes. */
static inline Count drilling_state_size(const Drilling *d) {
    const State *now = &d->propagation.now;
    return FIXED_NUMBERS + NUMBERS_OF_PIECE * (now->pieces.end - now->pieces.first) +
           NUMBERS_OF_KINK * (now->kinks_end - now->ahead[d->propagation.scaled.n - 1]);
}

/* Write everything that evolves. */
static inline void drilling_save(Drilling *d, double *state) {
    Tape tape = {state, 0};
    pass_state(&tape, d);
}

static inline int is_whole(double value, double least, double most) {
    return value >= least && value <= most && value == floor(value);
}

/* Whether these numbers can be a state: counts that agree, flags that are some, nothing that is no number. */
static inline int is_state(const Drilling *d, const double *state, Count count) {
    int n = d->propagation.scaled.n;
    if (count < FIXED_NUMBERS) return 0;
    double pieces = state[0], kinks = state[1], most = (double)count;
    if (!is_whole(pieces, 1, most) || !is_whole(kinks, 0, most)) return 0;
    if ((double)FIXED_NUMBERS + (double)NUMBERS_OF_PIECE * pieces + (double)NUMBERS_OF_KINK * kinks != most) return 0;
    for (int i = 0; i < MAX_STABILIZERS; i++)
        if (!is_whole(state[2 + 2 * i], 0, kinks) || !is_whole(state[3 + 2 * i], -1, 1)) return 0;
    if (state[2 * n] != 0) return 0; /* the last stabilizer is the last to pass a kink */
    if (!is_whole(state[WHOLE_NUMBERS - 3], -1, 1) || !is_whole(state[WHOLE_NUMBERS - 2], NONE, n - 1)) return 0;
    if (!is_whole(state[WHOLE_NUMBERS - 1], -1, 1) || !(state[WHOLE_NUMBERS] > 0)) return 0;
    for (Count k = WHOLE_NUMBERS + 1; k < count; k++)
        if (!isfinite(state[k])) return 0;
    double xi = state[AT_XI];
    if (state[AT_LENGTH] < 0 || state[AT_LENGTH] / length_scale(&d->system) != xi) return 0;
    if (!(state[AT_ETA_PI] > 0) || !isfinite(1 / state[AT_ETA_PI]) || state[AT_INPUTS_XI] > xi) return 0;
    if (state[AT_STEP] > xi || xi > state[AT_STEP_END] || !(state[AT_STEP + 1] > 0)) return 0;
    for (Count k = 0; k < (Count)pieces; k++) { /* the hole is in one piece, and the last is that of the step */
        const double *at = state + FIXED_NUMBERS + NUMBERS_OF_PIECE * k, *step = state + AT_STEP;
        int last = k + 1 == (Count)pieces, stands = state[AT_STEP_END] == step[0];
        double end = last ? step[0] : at[NUMBERS_OF_PIECE], Y = last ? state[AT_Y] : at[NUMBERS_OF_PIECE + 2];
        if (at[NUMBERS_OF_PIECE - 1] != 0 && !(at[NUMBERS_OF_PIECE - 1] > 0)) return 0;
        if (!(at[1] > 0) || end < at[0] || !(fabs(polynomial(at + 2, (end - at[0]) * at[1]) - Y) <= MERGE)) return 0;
        if (last && !stands && (at[0] != step[0] || at[1] != 1 / step[1])) return 0;
        if (last && !stands && memcmp(at + 2, state + AT_Y, (S + 1) * sizeof *at)) return 0;
    }
    for (Count k = count - 1; k >= count - NUMBERS_OF_KINK * (Count)kinks; k -= NUMBERS_OF_KINK)
        if (!is_whole(state[k], 1, SMOOTHEST_KINK)) return 0;
    return 1;
}

/* Capacity that a state needs. */
static inline Count drilling_state_capacity(const double *state, Count count) {
    Count capacity = LEAST_CAPACITY;
    double wanted = count < FIXED_NUMBERS ? 0 : larger(state[0], state[1]);
    while ((double)capacity < 2 * wanted + 2 && capacity < 4 * count) capacity *= 2;
    return capacity;
}

/* Go back to a state that this run has saved itself. */
static inline void drilling_return(Drilling *d, const double *state) {
    Tape tape = {(double *)state, 1}; /* which is only read */
    pass_state(&tape, d);
    d->propagation.law_known = d->propagation.under_way = 0;
}

/* Go to a state of a run with the same system, if it can be one. */
static inline Status drilling_restore(Drilling *d, const double *state, Count count, char why[MESSAGE]) {
    if (!is_state(d, state, count)) {
        snprintf(why, MESSAGE, "state: must be one of this system, got %lld numbers that are none", count);
        return FAILED;
    }
    if (d->propagation.hole.capacity < drilling_state_capacity(state, count)) return FULL;
    drilling_return(d, state);
    return DONE;
}

/* Go on in a larger memory; the old one may be freed then. */
static inline void drilling_move(Drilling *d, void *memory, Count capacity) {
    Propagation *p = &d->propagation;
    State *now = &p->now;
    Hole hole = lay_out(memory, capacity);
    Count first_piece = p->under_way ? p->oldest_piece : now->pieces.first;
    Count first_kink = p->under_way ? p->oldest_kink : now->ahead[p->scaled.n - 1];
    for (Count k = first_piece; k < now->pieces.end; k++) *piece(&hole, k) = *piece(&p->hole, k);
    for (Count k = first_kink; k < now->kinks_end; k++) *kink(&hole, k) = *kink(&p->hole, k);
    p->hole = hole;
}

/* m drilled. */
static inline double drilling_length(const Drilling *d) { return d->drilled_length; }

#endif
