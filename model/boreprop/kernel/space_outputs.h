/* The outputs where the bit is, in space. */
#ifndef BOREPROP_SPACE_OUTPUTS_H
#define BOREPROP_SPACE_OUTPUTS_H

#include "drilling.h"

/* What the outputs are computed from: the state where the bit is. */
typedef struct {
    double l1, F_star, path[AXES], T[AXES], earlier[DIRECTIONS], x[COMPONENTS];
    double high[DIRECTIONS]; /* the side from which parts of forces and tilt are counted, in (e₂, e₃) */
    ScaledInputs inputs;
    Response is;
    double body_force[DIRECTIONS], body_place, wall_distance; /* the largest force, and where it acts; the least gap */
    Sensed sensed[MAX_SENSORS];
    double told[MAX_SENSORS][DIRECTIONS];
} Present;

#define NEARLY_VERTICAL 0.05233595624294383 /* sine of 3 degrees: up to here the high side says little */

/* The direction, in (e₂, e₃), that "high" stands for: the high side, and north where the bit is nearly vertical. */
static inline void high_side(const Frame *frame, double high[DIRECTIONS]) {
    const double *down = frame->row[DOWN], *north = frame->row[NORTH];
    int vertical = hypot(down[HIGH], down[RIGHT]) < NEARLY_VERTICAL;
    double to[DIRECTIONS] = {vertical ? north[HIGH] : -down[HIGH], vertical ? north[RIGHT] : -down[RIGHT]};
    double size = length_of(to);
    for (int d = 0; d < DIRECTIONS; d++) high[d] = to[d] / size;
}

/* What the wall does to the body of the BHA. */
static inline void find_body(Integrator *p, Present *at) {
    Pull pull[DIRECTIONS];
    at->body_force[0] = at->body_force[1] = at->body_place = 0.0, at->wall_distance = INFINITY;
    if (!p->scaled.points) return;
    for (int i = p->scaled.n; i < p->now.places.count; i++) {
        if (length_of(at->is.at.F[i]) <= length_of(at->body_force)) continue;
        memcpy(at->body_force, at->is.at.F[i], sizeof at->body_force), at->body_place = p->now.places.s[i];
    }
    pull_under(p, &at->is, pull);
    at->wall_distance = wall_distance(p, p->now.xi, at->x, pull);
}

/* Find all that. */
static inline void find_present(Drilling *d, Present *at) {
    Integrator *p = &d->integrator;
    const State *now = &p->now;
    at->l1 = length_scale(&d->system), at->F_star = force_scale(&d->system);
    at->inputs = inputs_here(now);
    step_state(&now->step, now->xi, at->x);
    at->is = respond(p, at->x, at->inputs);
    high_side(&at->is.frame, at->high);
    position(now, at->path);
    const Piece *own = piece(&now->hole, find_from(&now->hole, now->hole.cursor[0], now->xi - 1.0));
    for (int k = 0; k < DIRECTIONS; k++)
        at->earlier[k] = polynomial_slope(own->x[LATERAL + k], (now->xi - 1.0 - own->start) * own->rate) * own->rate;
    for (int axis = NORTH; axis <= DOWN; axis++) {
        double back[DIRECTIONS] = {-at->is.at.psi[0], -at->is.at.psi[1]}, turned[3];
        turned_row(at->is.frame.row[axis], back, turned);
        at->T[axis] = turned[AHEAD];
    }
    find_body(p, at);
    if (!p->scaled.sensors) return;
    Bending bending[DIRECTIONS];
    bend_under(p, &at->is, bending);
    find_sensed(p, at->x, bending, at->sensed, at->told);
}

/* The inclination of the hole between two places behind the bit, whose offsets from the bit's axis are given, on average. */
static inline double mean_inclination(const Present *at, const double from[2], const double to[2], double length) {
    double turn[DIRECTIONS], row[3], sideways = 0.0, down = 0.0;
    for (int d = 0; d < DIRECTIONS; d++) turn[d] = (to[d] - from[d]) / length;
    for (int axis = NORTH; axis <= DOWN; axis++) {
        turned_row(at->is.frame.row[axis], turn, row);
        if (axis == DOWN) down = row[AHEAD];
        else sideways = hypot(sideways, row[AHEAD]);
    }
    return atan2(sideways, down);
}

/* The part of a vector in (e₂, e₃) to the high side, and that to the right of it. */
static inline double part_high(const Present *at, const double a[2]) { return a[0] * at->high[0] + a[1] * at->high[1]; }
static inline double part_right(const Present *at, const double a[2]) {
    return a[1] * at->high[0] - a[0] * at->high[1];
}

/* One output, the value with this index if it has several. If an output of the table were missing, it would not compile. */
static inline double output(const Drilling *d, const Present *at, Output which, int i) {
    static const double nothing[2] = {0.0, 0.0};
    const Reply *is = &at->is.at;
    const Frame *frame = &at->is.frame;
    double l1 = at->l1, F_star = at->F_star;
    double turned[DIRECTIONS] = {at->is.Theta[0] - at->earlier[0], at->is.Theta[1] - at->earlier[1]};
    switch (which) {
        case OUT_DRILLED_LENGTH: return d->drilled_length;
        case OUT_BIT_INCLINATION:
            return atan2(hypot(frame->row[NORTH][AHEAD], frame->row[EAST][AHEAD]), frame->row[DOWN][AHEAD]);
        case OUT_BIT_AZIMUTH: return atan2(frame->row[EAST][AHEAD], frame->row[NORTH][AHEAD]);
        case OUT_BOREHOLE_INCLINATION: return atan2(hypot(at->T[NORTH], at->T[EAST]), at->T[DOWN]);
        case OUT_BOREHOLE_AZIMUTH: return atan2(at->T[EAST], at->T[NORTH]);
        case OUT_BIT_TILT: return length_of(is->psi);
        case OUT_BIT_TILT_HIGH: return part_high(at, is->psi);
        case OUT_BIT_TILT_RIGHT: return part_right(at, is->psi);
        case OUT_AVERAGE_INCLINATION: /* λ_i (⟨Θ⟩_i − θ) = e_i − e_{i−1} */
            return mean_inclination(at, i ? at->is.e[i - 1] : nothing, at->is.e[i], lambda_(&d->integrator.scaled, i));
        case OUT_STABILIZER_DEFLECTION: return length_of(at->is.delta[i]) * l1;
        case OUT_STABILIZER_DEFLECTION_HIGH: return part_high(at, at->is.delta[i]) * l1;
        case OUT_STABILIZER_DEFLECTION_RIGHT: return part_right(at, at->is.delta[i]) * l1;
        case OUT_STABILIZER_FORCE: return length_of(is->F[i]) * F_star;
        case OUT_STABILIZER_FORCE_HIGH: return part_high(at, is->F[i]) * F_star;
        case OUT_STABILIZER_FORCE_RIGHT: return part_right(at, is->F[i]) * F_star;
        case OUT_STABILIZER_CONTACT: return length_of(is->F[i]) > 0;
        case OUT_BIT_TILT_SATURATION: return at->is.regime.saturation;
        case OUT_BIT_LATERAL_FORCE: return length_of(is->F_0) * F_star;
        case OUT_BIT_LATERAL_FORCE_HIGH: return part_high(at, is->F_0) * F_star;
        case OUT_BIT_LATERAL_FORCE_RIGHT: return part_right(at, is->F_0) * F_star;
        case OUT_BIT_MOMENT: return length_of(is->M) * F_star * l1;
        case OUT_BOREHOLE_CURVATURE: return length_of(turned) / l1;
        case OUT_BODY_CONTACT_FORCE: return length_of(at->body_force) * F_star;
        case OUT_BODY_CONTACT_FORCE_HIGH: return part_high(at, at->body_force) * F_star;
        case OUT_BODY_CONTACT_FORCE_RIGHT: return part_right(at, at->body_force) * F_star;
        case OUT_BODY_CONTACT_POSITION: return at->body_place * l1;
        case OUT_WALL_DISTANCE: return at->wall_distance * l1;
        case OUT_SENSOR_INCLINATION: return at->told[i][INCLINATION];
        case OUT_SENSOR_AZIMUTH: return at->told[i][AZIMUTH];
        case OUT_SENSOR_BENDING_MOMENT: return length_of(at->sensed[i].moment) * F_star * l1;
        case OUT_SENSOR_BENDING_MOMENT_HIGH: return part_high(at, at->sensed[i].moment) * F_star * l1;
        case OUT_SENSOR_BENDING_MOMENT_RIGHT: return part_right(at, at->sensed[i].moment) * F_star * l1;
        case OUT_SENSOR_CLEARANCE:
            return (d->integrator.scaled.sensor[i].clearance - length_of(at->sensed[i].offset)) * l1;
        case OUT_FORMATION: return d->integrator.now.layer;
        case OUT_NORTH: return at->path[NORTH] * l1;
        case OUT_EAST: return at->path[EAST] * l1;
        case OUT_DISPLACEMENT: return hypot(at->path[NORTH], at->path[EAST]) * l1;
        case OUT_TRUE_VERTICAL_DEPTH: return at->path[DOWN] * l1;
        case OUT_ETA_PI: return at->inputs.eta_pi;
    }
    return NAN;
}

#endif
