/* A drilling run in SI units: the shell around the propagation. Nothing here allocates: the caller gives the memory. */
#ifndef BOREPROP_DRILLING_H
#define BOREPROP_DRILLING_H

#include "propagation.h"

enum { LEAST_CAPACITY = 256, MOST_PIECES = 1 << 19 }; /* of hole: enough for most, and little memory to go through */

/* A borehole as it is drilled, from the end of the survey on. */
typedef struct {
    System system;
    double drilled_length; /* m */
    Inputs given;        /* the inputs that were given for the way here, without what layers and wear make of them; … */
    Inputs acting;       /* … those that were last to act, and … */
    ScaledInputs scaled; /* … what these are in the paper's numbers */
    Ground ground;
    double buckling_weight;          /* over F*: under it the BHA buckles; infinite if the axial load does not count */
    int values, count[OUTPUT_COUNT]; /* how many values its outputs have, and each of them has */
    Integrator integrator;
} Drilling;

/* Count the values of the outputs. */
static inline void count_values(Drilling *d) {
    d->values = 0;
    for (int k = 0; k < OUTPUT_COUNT; k++) {
        d->count[k] = value_count(OUTPUT_SIZE[k], d->system.structure);
        d->values += d->count[k];
    }
}

/* Whether bit and rock are in their ranges, and ε = χ/η and its inverse finite. */
static inline int check_rock(Inputs inputs, Problem *problem) {
    double eta = inputs.lateral_steering_resistance, chi = inputs.angular_steering_resistance;
    return check_quantity(&INPUT_TABLE[IN_LATERAL_STEERING_RESISTANCE], 0, eta, problem) &&
           check_quantity(&INPUT_TABLE[IN_ANGULAR_STEERING_RESISTANCE], 0, chi, problem) &&
           check_quantity(&INPUT_TABLE[IN_BIT_TILT_LIMIT], 0, inputs.bit_tilt_limit, problem) &&
           check_positive(Q_EPSILON, chi / eta, problem) &&
           check_finite(Q_INVERSE_EPSILON, 0, 1 / (chi / eta), problem);
}

/* Whether toolface and walk, which count in space, are in their ranges. */
static inline int check_aim(Inputs inputs, Problem *problem) {
    return DIRECTIONS == 1 ||
           (check_quantity(&INPUT_TABLE[IN_RSS_TOOLFACE], 0, inputs.rss_toolface, problem) &&
            check_quantity(&INPUT_TABLE[IN_TOOLFACE_REFERENCE], 0, inputs.toolface_reference, problem) &&
            check_quantity(&INPUT_TABLE[IN_BIT_WALK_ANGLE], 0, inputs.bit_walk_angle, problem));
}

static inline int check_inputs(Inputs inputs, Problem *problem) {
    return check_rock(inputs, problem) && check_aim(inputs, problem) &&
           check_quantity(&INPUT_TABLE[IN_RSS_FORCE], 0, inputs.rss_force, problem) &&
           check_quantity(&INPUT_TABLE[IN_ACTIVE_WEIGHT_ON_BIT], 0, inputs.active_weight_on_bit, problem) &&
           check_finite(Q_RSS_FORCE_SLOPE, 0, inputs.rss_force_slope, problem) &&
           check_finite(Q_ACTIVE_WEIGHT_ON_BIT_SLOPE, 0, inputs.active_weight_on_bit_slope, problem) &&
           check_finite(Q_LATERAL_STEERING_RESISTANCE_SLOPE, 0, inputs.lateral_steering_resistance_slope, problem) &&
           check_finite(Q_ANGULAR_STEERING_RESISTANCE_SLOPE, 0, inputs.angular_steering_resistance_slope, problem) &&
           check_finite(Q_BIT_TILT_LIMIT_SLOPE, 0, inputs.bit_tilt_limit_slope, problem);
}

/* Take the inclination, of which this is the cosine, as that at which the weight acts along the beam. */
static inline void take_cosine(Drilling *d, double cosine) {
    Integrator *p = &d->integrator;
    p->now.cosine = p->scaled.axial ? cosine : 0.0;
    d->buckling_weight = p->scaled.axial ? buckling_weight(&p->scaled, cosine) : INFINITY;
    if (DIRECTIONS > 1 && p->scaled.axial) { /* a stabilizer that touches does not hold the BHA sideways */
        Contact nothing = {{0}, 0, {0}};
        d->buckling_weight = borne(p, &nothing, d->buckling_weight);
    }
}

/* All of the weight on bit, N: the active weight if none is given. */
static inline double whole_weight(Inputs inputs) {
    return inputs.weight_on_bit == 0 ? inputs.active_weight_on_bit : inputs.weight_on_bit;
}

/* Whether a BHA under axial load bears the weight on bit. */
static inline int check_weight(const Drilling *d, Inputs inputs, Problem *problem) {
    double weight = whole_weight(inputs), least = inputs.active_weight_on_bit;
    double most = d->buckling_weight * force_scale(&d->system);
    if (!check_number(Q_WEIGHT_ON_BIT, 0, weight, -INFINITY, least, INFINITY, problem)) return 0;
    Code code = DIRECTIONS > 1 ? BUCKLES_IN_SPACE : BUCKLES;
    return weight < most || wrong(problem, code, Q_WEIGHT_ON_BIT, 0, weight, most);
}

/* The inputs as the paper's numbers. */
static inline ScaledInputs scale_inputs(const System *system, Inputs given) {
    double F_star = force_scale(system), l1 = length_scale(system);
    double eta = given.lateral_steering_resistance, eta_slope = given.lateral_steering_resistance_slope;
    double chi = given.angular_steering_resistance, chi_slope = given.angular_steering_resistance_slope;
    double weight = given.active_weight_on_bit, weight_slope = given.active_weight_on_bit_slope;
    ScaledInputs scaled = {
        .F_rss = given.rss_force / F_star,
        .eta_pi = eta_pi(system, eta, weight),
        .chi_pi = chi / eta * eta_pi(system, eta, weight),
        .psi_star = given.bit_tilt_limit,
        .F_rss_slope = given.rss_force_slope * l1 / F_star,
        .eta_pi_slope = (eta * weight_slope + eta_slope * weight) / F_star * l1,
        .chi_pi_slope = (chi * weight_slope + chi_slope * weight) / F_star * l1,
        .psi_star_slope = given.bit_tilt_limit_slope * l1,
        .eta_pi_curve = eta_slope * weight_slope / F_star * l1 * l1,
        .chi_pi_curve = chi_slope * weight_slope / F_star * l1 * l1,
        .W = system->structure.axial ? whole_weight(given) / F_star : 0.0,
#ifdef SPACE
        .toolface = given.rss_toolface,
        .reference = given.toolface_reference,
        .walk = given.bit_walk_angle,
#endif
    };
    return scaled;
}

/* Make inputs dimensionless; 0, and the problem, if these numbers, or the inputs, are out of range. */
static inline int scale_checked(const Drilling *d, Inputs inputs, ScaledInputs *scaled, Problem *problem) {
    *scaled = scale_inputs(&d->system, inputs);
    return check_inputs(inputs, problem) && (!d->system.structure.axial || check_weight(d, inputs, problem)) &&
           check_finite(Q_SCALED_FORCE, 0, scaled->F_rss, problem) &&
           check_finite(Q_SCALED_SLOPE, 0, scaled->F_rss_slope, problem) &&
           check_positive(Q_ETA_PI, scaled->eta_pi, problem) &&
           check_finite(Q_ETA_PI_CHANGE, 0, scaled->eta_pi_slope + scaled->eta_pi_curve, problem) &&
           check_finite(Q_CHI_PI_CHANGE, 0, scaled->chi_pi_slope + scaled->chi_pi_curve, problem) &&
           check_finite(Q_PSI_STAR_CHANGE, 0, scaled->psi_star_slope, problem) &&
           check_finite(Q_INVERSE_ETA_PI, 0, 1 / scaled->eta_pi, problem);
}

/* Let inputs act, if they may. */
static inline int let_act(Drilling *d, Inputs inputs, Problem *problem) {
    ScaledInputs scaled;
    if (!memcmp(&inputs, &d->acting, sizeof inputs)) return 1;
    if (!scale_checked(d, inputs, &scaled, problem)) return 0;
    d->acting = inputs, d->scaled = scaled;
    return 1;
}

/* The capacity, in pieces of hole, that a run needs if its inputs do not change often. */
static inline Count drilling_capacity(const System *system, const Survey *survey) {
    double l1 = length_scale(system), reach = LOOK_BACK + system->stabilizer_position[system->structure.n - 1] / l1;
    Count count, first = first_station(survey, l1, reach, &count), capacity = LEAST_CAPACITY;
    while (capacity < 4 * (count - first)) capacity *= 2;
    return capacity;
}

/* Bytes of memory for a capacity, which is a power of two. */
static inline size_t drilling_memory(Count capacity) { return (size_t)capacity * (sizeof(Piece) + sizeof(Kink)); }

/* Where the kinks lie in that memory: behind the pieces. */
static inline Kink *kinks_in(void *memory, Count capacity) { return (Kink *)(void *)((Piece *)memory + capacity); }

/* Go on in a larger memory; the old one may be freed afterwards. */
static inline void drilling_move(Drilling *d, void *memory, Count capacity) {
    move_rings(&d->integrator, memory, kinks_in(memory, capacity), capacity);
}

/* Prepare a drilling system, to be followed by `drilling_start` or `drilling_restore`. The memory, and the numbers of the
   ground, must live on. The tolerance of the system takes the place of that of the options. */
static inline Status drilling_prepare(
    Drilling *d, const System *system, Ground ground, Options options, void *memory, Count capacity, Problem *problem
) {
    if (!check_system(system, problem)) return FAILED;
    if (!check_positive(Q_FORCE_SCALE, force_scale(system), problem)) return FAILED;
    Scaled scaled = scale(system);
    if (!check_finite(Q_SCALED_REACH, 0, scaled.s[scaled.n - 1], problem) ||
        !check_finite(Q_SCALED_WEIGHT, 0, scaled.w, problem))
        return FAILED;
    d->system = *system, d->ground = ground;
    d->drilled_length = 0.0;
    count_values(d);
    d->given.rss_force = d->acting.rss_force = (double)NAN; /* none so far */
    options.relative_tolerance = system->relative_tolerance;
    prepare(&d->integrator, &scaled, length_scale(system), force_scale(system), options);
    take_cosine(d, 0.0);
    drilling_move(d, memory, capacity);
    return DONE;
}

/* Start at the end of the survey, which need not live on. */
static inline Status drilling_start(Drilling *d, const Survey *survey, Inputs inputs, Problem *problem) {
    if (!check_survey(survey, problem)) return FAILED;
    take_cosine(d, cos(survey->inclination[survey->count - 1]));
    int layer = d->integrator.now.layer = first_layer(&d->ground);
    if (!let_act(d, d->ground.there ? rock_in(&d->ground, layer, inputs) : inputs, problem)) return FAILED;
    if (d->integrator.now.hole.capacity < drilling_capacity(&d->system, survey)) return FULL;
    return begin(&d->integrator, survey, d->scaled, problem);
}

/* Whether the way to `xi` lies within the present step and layer, so that nothing but the bit moves unless inputs do. */
static inline int is_ahead(const Drilling *d, double xi) {
    const Integrator *p = &d->integrator;
    int stays = !d->ground.there || (p->exit_known && !(p->exit_side && p->exit <= xi));
    return xi <= p->now.step.end && stays && d->ground.weight_per_metre == 0;
}

/* Drill on to `xi` through the ground, under inputs that are given for a sharp bit and the rock without layers; as `drill`. */
static inline Status drill_through(Drilling *d, double xi, Inputs given, Problem *problem) {
    Integrator *p = &d->integrator;
    State *now = &p->now;
    double l1 = length_scale(&d->system), start = d->drilled_length / l1, end;
    int left;
    if (!is_ahead(d, xi) && !set_out(p)) return FULL;
    if (d->system.structure.axial) given.weight_on_bit = whole_weight(given);
    do {
        double until;
        Inputs inputs = rock_in(&d->ground, now->layer, given_ahead(given, (now->xi - start) * l1));
        int good = wear_off(&d->ground, now->xi * l1, xi * l1, &inputs, &until, problem);
        Status status = good && let_act(d, inputs, problem) ? DONE : FAILED;
        end = smaller(xi, until / l1);
        if (status == DONE && are_others(now, d->scaled, end - now->xi)) {
            if (!set_out(p) || !has_room(p)) return FULL;
            status = steer(p, d->scaled, problem);
        }
        if (status == DONE) status = drill_in_layer(p, &d->ground, end, &left, problem);
        if (status == FAILED) go_back(p);
        if (status != DONE) return status;
        if (!left) now->xi = end;
        read_sensors(p, now->xi);
    } while (left || end < xi);
    p->under_way = 0;
    return DONE;
}

/* Go on in the present step and layer to `xi` under the inputs that have led here; 0 if the way leads farther. */
static inline int go_straight_on(Drilling *d, double xi) {
    Integrator *p = &d->integrator;
    if (!is_ahead(d, xi) || are_ramps(&p->now.inputs)) return 0;
    p->now.xi = xi;
    read_sensors(p, xi);
    return 1;
}

/* Drill on to a length, m from the start, under inputs from here; where the bit is, only they are taken over.
   After FULL: `drilling_move`, and the same call again, which goes on; or `drilling_cancel`, and nothing has moved. */
static inline Status drilling_advance(Drilling *d, double drilled_length, Inputs inputs, Problem *problem) {
    int there = d->ground.there, same = !memcmp(&inputs, &d->given, sizeof inputs);
    double xi = drilled_length / length_scale(&d->system);
    ScaledInputs scaled; /* of no use where layers stand in */
    if (!(same && drilled_length >= d->drilled_length && go_straight_on(d, xi))) {
        if (!(there ? same || scale_checked(d, inputs, &scaled, problem) : let_act(d, inputs, problem))) return FAILED;
        if (!check_number(Q_DRILLED_LENGTH, 0, drilled_length, -INFINITY, d->drilled_length, INFINITY, problem))
            return FAILED;
        Status status = there ? drill_through(d, xi, inputs, problem) : drill(&d->integrator, xi, d->scaled, problem);
        if (status != DONE) return status;
        d->given = inputs;
    }
    d->drilled_length = drilled_length;
    return DONE;
}

/* Whether clearances, m, are others than those that the stabilizers have. */
static inline int has_other_clearances(const Drilling *d, const double *clearances) {
    for (int i = 0; i < d->system.structure.n - 1; i++)
        if (clearances[i] / length_scale(&d->system) != d->integrator.now.y_star[i]) return 1;
    return 0;
}

/* Let the stabilizers have other clearances, m, from where the bit is; after FULL as `drilling_advance`. */
static inline Status drilling_change_clearances(Drilling *d, const double *clearances, Problem *problem) {
    double y_star[MAX_STABILIZERS] = {0};
    if (!has_other_clearances(d, clearances)) return DONE;
    for (int i = 0; i < d->system.structure.n - 1; i++) {
        if (!check_number(Q_STABILIZER_CLEARANCE, i + 1, clearances[i], -INFINITY, 0.0, INFINITY, problem))
            return FAILED;
        y_star[i] = clearances[i] / length_scale(&d->system);
    }
    return change_clearances(&d->integrator, y_star, problem);
}

/* Drill on to the end of the next step, under the inputs as they are; after FULL as `drilling_advance`. */
static inline Status drilling_step(Drilling *d, Problem *problem) {
    Status status = drill_step(&d->integrator, problem);
    if (status == DONE) d->drilled_length = d->integrator.now.xi * length_scale(&d->system);
    return status;
}

static inline void drilling_cancel(Drilling *d) { go_back(&d->integrator); }

/* The length drilled, m. */
static inline double drilling_length(const Drilling *d) { return d->drilled_length; }

#endif
