/* A drilling run in SI units: the shell around the propagation. Nothing here allocates: the caller gives the memory. */
#ifndef BOREPROP_DRILLING_H
#define BOREPROP_DRILLING_H

#include "propagation.h"

enum { LEAST_CAPACITY = 1024, MOST_PIECES = 1 << 19 }; /* of hole */
enum { MOST_OUTPUTS = 4 * MAX_STABILIZERS + 8 };

/* RSS force, N, and its change per metre drilled, N/m, from where the bit is on; weight on bit, N. */
typedef struct {
    double rss_force, rss_force_slope, active_weight_on_bit;
} Inputs;

/* A borehole as it is drilled, from the end of the survey on. */
typedef struct {
    System system;
    double drilled_length; /* m */
    Integrator integrator;
} Drilling;

static inline int check_inputs(Inputs inputs, char why[MESSAGE]) {
    return check_finite("rss_force", inputs.rss_force, why) &&
           check_finite("rss_force_slope", inputs.rss_force_slope, why) &&
           check_positive("active_weight_on_bit", inputs.active_weight_on_bit, why);
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

/* Where the kinks lie in it: behind the pieces. */
static inline Kink *kinks_in(void *memory, Count capacity) { return (Kink *)(void *)((Piece *)memory + capacity); }

/* Go on in a larger memory; the old one may be freed then. */
static inline void drilling_move(Drilling *d, void *memory, Count capacity) {
    move_rings(&d->integrator, memory, kinks_in(memory, capacity), capacity);
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
    prepare(&d->integrator, &scaled, length_scale(system), system->relative_tolerance);
    drilling_move(d, memory, capacity);
    return DONE;
}

/* Start at the end of the survey, which need not live on. */
static inline Status drilling_start(Drilling *d, const Survey *survey, Inputs inputs, char why[MESSAGE]) {
    ScaledInputs scaled_inputs;
    if (!check_survey(survey, why)) return FAILED;
    if (!scale_inputs(&d->system, inputs, &scaled_inputs, why)) return FAILED;
    if (d->integrator.now.hole.capacity < drilling_capacity(&d->system, survey)) return FULL;
    return begin(&d->integrator, survey, scaled_inputs, why);
}

/* Drill on to a length, m from the start, under inputs from here; where the bit is, only they are taken over.
   After FULL: `drilling_move`, and the same call again, which goes on; or `drilling_cancel`, and nothing has moved. */
static inline Status drilling_advance(Drilling *d, double drilled_length, Inputs inputs, char why[MESSAGE]) {
    ScaledInputs scaled_inputs;
    if (!scale_inputs(&d->system, inputs, &scaled_inputs, why)) return FAILED;
    if (!check_at_least("drilled_length", drilled_length, d->drilled_length, why)) return FAILED;
    double xi = drilled_length / length_scale(&d->system);
    Status status = drill(&d->integrator, xi, scaled_inputs, why);
    if (status == DONE) d->drilled_length = drilled_length;
    return status;
}

static inline void drilling_cancel(Drilling *d) { go_back(&d->integrator); }

/* Every output of the table of variables where the bit is, in its order; returns how many. */
static inline int drilling_outputs(Drilling *d, double out[MOST_OUTPUTS]) {
    Integrator *p = &d->integrator;
    const State *now = &p->now;
    int n = p->scaled.n;
    double l1 = length_scale(&d->system), F_star = force_scale(&d->system), psi_star = p->scaled.psi_star;
    double earlier = earlier_inclination(p, now->xi - 1.0);
    double state[COMPONENTS], x, z, *next = out;
    step_state(&now->step, now->xi, state);
    double theta = state[ANGLE];
    Loads loads = present_loads(p);
    const Mode *mode = settle(&p->modes, &loads, now->regime.contact);
    double F[MAX_STABILIZERS] = {0}, F_0 = row_value(&mode->F_0, &loads, n);
    double psi = bit_tilt(F_0, now->inputs.eta_pi, psi_star), Theta = theta - psi;
    for (int i = 0; i < n - 1; i++) F[i] = row_value(&mode->F[i], &loads, n);
    position(now, &x, &z);
    *next++ = d->drilled_length;
    *next++ = theta;
    *next++ = Theta;
    *next++ = psi;
    for (int i = 0; i < n; i++) /* λ_i (⟨Θ⟩_i − θ) = e_i − e_{i−1} */
        *next++ = theta + (loads.e[i] - (i ? loads.e[i - 1] : 0.0)) / lambda_(&p->scaled, i);
    for (int i = 0; i < n - 1; i++) *next++ = row_value(&mode->delta[i], &loads, n) * l1;
    for (int i = 0; i < n - 1; i++) *next++ = F[i] * F_star;
    for (int i = 0; i < n - 1; i++) *next++ = wall(F[i]);
    *next++ = side_beyond(F_0 / now->inputs.eta_pi, -psi_star, psi_star, ROUNDING);
    *next++ = F_0 * F_star;
    *next++ = -row_value(&mode->M, &loads, n) * F_star * l1;
    *next++ = (Theta - earlier) / l1;
    *next++ = x * l1;
    *next++ = z * l1;
    *next++ = now->inputs.eta_pi;
    return (int)(next - out);
}

/* m drilled. */
static inline double drilling_length(const Drilling *d) { return d->drilled_length; }

#endif
