/* The drilling system in SI units, and the paper's dimensionless numbers made from it. */
#ifndef BOREPROP_SYSTEM_H
#define BOREPROP_SYSTEM_H

#include "checks.h"
#include "dimensions.h"
#include "linear.h"
#include "quantities.h"

/* What the wall may push: the stabilizers, of which it never pushes the last, and points of the body between them. */
enum { MAX_SUPPORTS = MAX_STABILIZERS + MAX_POINTS };
/* How many supports may touch a wall, or be near enough to it to be watched, at once. */
enum { MAX_PLACES = SIZE / DIRECTIONS, MAX_WATCHED = MAX_PLACES - MAX_STABILIZERS };

/* The places behind the bit where the hole has a say: how many, how far behind, and the least of these distances. */
typedef struct {
    int count;
    double nearest, s[MAX_PLACES];
} Places;

/* Where a sensor is, how it reads the inclination, and the clearance of a centred body there. */
typedef struct {
    double s, interval, bias, noise, seed, clearance;
} Sensor;

/* The drilling system in the paper's numbers: lengths over ℓ₁, forces over F*, moments over F*ℓ₁. */
typedef struct {
    int n;
    /* s_1 … s_n, distance of the stabilizers from the bit, s_1 = 1; then of the points of the body */
    double s[MAX_SUPPORTS];
    double y_star[MAX_SUPPORTS];       /* y*_1 … y*_{n−1}; nothing for the last stabilizer; then that of the points */
    int points;                        /* of the body */
    double Delta;                      /* distance of the RSS from the bit */
    double w;                          /* w̃ = w ℓ₁ / F* */
    int sections;                      /* of the beam, at least one */
    double section_end[MAX_SECTIONS];  /* how far each reaches from the bit */
    double section_beta[MAX_SECTIONS]; /* its EI over that at the bit */
    double section_w[MAX_SECTIONS];    /* its w̃ */
    double end_deflection;             /* δ_n */
    int uniform, axial; /* whether the beam has no sections and bears no axial load; whether it bears one */
    int stepped;        /* whether it is solved stretch by stretch: not uniform, or its body may touch */
    int sensors;
    Sensor sensor[MAX_SENSORS];
} Scaled;

/* How many values a quantity has. */
static inline int value_count(Size size, Structure structure) {
    switch (size) {
        case ONE: return 1;
        case EACH_STABILIZER: return structure.n;
        case EACH_NON_IDEAL: return structure.n - 1;
        case IF_UNIFORM: return !structure.sections;
        case EACH_SECTION: return structure.sections;
        case IF_STEPPED: return structure.sections > 0;
        case IF_AXIAL: return structure.axial;
        case EACH_POINT: return structure.points;
        case IF_POINTS: return structure.points > 0;
        case IF_SPACE: return structure.space;
        case IF_POINTS_IN_SPACE: return structure.space && structure.points > 0;
        case EACH_NON_IDEAL_IN_SPACE: return structure.space ? structure.n - 1 : 0;
        case IF_LAYERED: return structure.layered;
        case EACH_SENSOR: return structure.sensors;
        case EACH_SENSOR_IN_SPACE: return structure.space ? structure.sensors : 0;
    }
    return 0;
}

/* Whether the values of a quantity are numbered. */
static inline int is_list(Size size) {
    return size == EACH_STABILIZER || size == EACH_NON_IDEAL || size == EACH_SECTION || size == EACH_POINT ||
           size == EACH_SENSOR || size == EACH_NON_IDEAL_IN_SPACE || size == EACH_SENSOR_IN_SPACE;
}

/* Whether a structure is one that there is room for. */
static inline int check_structure(Structure structure, Problem *problem) {
    if (structure.n < 1 || structure.n > MAX_STABILIZERS)
        return wrong(problem, WRONG_COUNT, Q_STABILIZER_POSITION, 0, structure.n, MAX_STABILIZERS);
    if (structure.sections < 0 || structure.sections > MAX_SECTIONS)
        return wrong(problem, WRONG_COUNT, Q_SECTION_LENGTH, 0, structure.sections, MAX_SECTIONS);
    if (structure.points < 0 || structure.points > MAX_POINTS)
        return wrong(problem, WRONG_COUNT, Q_BODY_POINT_POSITION, 0, structure.points, MAX_POINTS);
    if (structure.sensors < 0 || structure.sensors > MAX_SENSORS)
        return wrong(problem, WRONG_COUNT, Q_SENSOR_POSITION, 0, structure.sensors, MAX_SENSORS);
    return 1;
}

/* Whether stabilizers, in their order, are far enough from each other and from the bit. */
static inline int check_spans(Name quantity, int count, const double *positions, Problem *problem) {
    for (int i = 0; i < count; i++) {
        double before = i ? positions[i - 1] : 0.0, after = positions[i];
        if (!(after - before < LEAST_SPAN * (1 - 1e-9)))
            continue; /* 4.34 and 4.35 are that far apart, but for rounding */
        wrong(problem, TOO_CLOSE, quantity, 0, after, LEAST_SPAN);
        problem->before = before;
        return 0;
    }
    return 1;
}

/* Whether a value of a quantity, the one with this index if it has several, is in its range. */
static inline int check_quantity(const Quantity *quantity, int index, double value, Problem *problem) {
    int shown = is_list(quantity->size) ? index + 1 : 0;
    return check_number(quantity->name, shown, value, quantity->above, quantity->at_least, quantity->at_most, problem);
}

/* The system of this structure with these parameters, one after the other in the order of the table. Nothing is read for
   a structure that `check_system` refuses. */
static inline System system_of(Structure structure, const double *values) {
    System system = {0};
    Problem problem;
    system.structure = structure;
    if (!check_structure(structure, &problem)) return system;
    for (int k = 0; k < PARAMETER_COUNT; k++) {
        int count = value_count(PARAMETER_TABLE[k].size, structure);
        memcpy((char *)&system + PARAMETER_TABLE[k].offset, values, (size_t)count * sizeof *values);
        values += count;
    }
    if (structure.sections) { /* scales are those of the section at the bit */
        system.flexural_stiffness = system.section_flexural_stiffness[0];
        system.distributed_weight = system.section_distributed_weight[0];
    }
    return system;
}

/* Whether the sections together reach the last stabilizer. */
static inline int check_reach(const System *system, Problem *problem) {
    double reach = 0.0, last = system->stabilizer_position[system->structure.n - 1];
    int sections = system->structure.sections;
    for (int k = 0; k < sections; k++) reach += system->section_length[k];
    if (!sections || reach >= last * (1 - 1e-9)) return 1;
    return wrong(problem, OUT_OF_REACH, Q_SECTION_LENGTH, 0, reach, last);
}

/* Whether the points of the body lie between the bit and the last stabilizer. */
static inline int check_body(const System *system, Problem *problem) {
    int points = system->structure.points;
    double last = system->stabilizer_position[system->structure.n - 1];
    return !points || check_at_most(Q_BODY_POINT_POSITION, system->body_point_position[points - 1], last, problem);
}

/* Whether the sensors are between the bit and the last stabilizer, and those with noise have an interval. */
static inline int check_sensors(const System *system, Problem *problem) {
    double last = system->stabilizer_position[system->structure.n - 1];
    for (int i = 0; i < system->structure.sensors; i++) {
        double position = system->sensor_position[i], interval = system->sensor_interval[i];
        double least = system->sensor_noise[i] > 0 ? 0.0 : -INFINITY;
        if (!check_number(Q_SENSOR_POSITION, i + 1, position, -INFINITY, -INFINITY, last, problem) ||
            !check_number(Q_SENSOR_INTERVAL, i + 1, interval, least, -INFINITY, INFINITY, problem))
            return 0;
    }
    return 1;
}

static inline int check_system(const System *system, Problem *problem) {
    const double *positions = system->stabilizer_position;
    int n = system->structure.n;
    if (!check_structure(system->structure, problem)) return 0;
    for (int k = 0; k < PARAMETER_COUNT; k++) {
        const Quantity *quantity = &PARAMETER_TABLE[k];
        const double *values = (const double *)(const void *)((const char *)system + quantity->offset);
        for (int i = 0; i < value_count(quantity->size, system->structure); i++)
            if (!check_quantity(quantity, i, values[i], problem)) return 0;
    }
    return check_increasing(Q_STABILIZER_POSITION, n, positions, problem) &&
           check_spans(Q_STABILIZER_POSITION, n, positions, problem) && check_reach(system, problem) &&
           check_increasing(Q_BODY_POINT_POSITION, system->structure.points, system->body_point_position, problem) &&
           check_at_most(Q_RSS_POSITION, system->rss_position, positions[0], problem) && check_body(system, problem) &&
           check_sensors(system, problem);
}

/* ℓ₁, m: the distance from the bit to the first stabilizer. */
static inline double length_scale(const System *system) { return system->stabilizer_position[0]; }

/* F* = 3EI/ℓ₁², N. */
static inline double force_scale(const System *system) {
    return 3.0 * system->flexural_stiffness / (length_scale(system) * length_scale(system));
}

/* From which side the toolface counts. */
enum { FROM_HIGH_SIDE, FROM_NORTH, FROM_FRAME };

/* The inputs where they were taken over: F_RSS, ηΠ, χΠ = εηΠ and ψ* with their changes per ξ, and those of ηΠ and χΠ,
   which are products of two that change, per ξ²; and the weight on the bit W, which is zero if the axial load does not
   count. */
typedef struct {
    double F_rss, eta_pi, chi_pi, psi_star;
    double F_rss_slope, eta_pi_slope, chi_pi_slope, psi_star_slope, eta_pi_curve, chi_pi_curve, W;
#ifdef SPACE
    double toolface, reference, walk; /* γ and where it counts from; ϖ */
#endif
} ScaledInputs;

/* F_RSS, ηΠ, χΠ and ψ* a length `ahead` of where inputs were taken over. */
static inline double F_rss_at(const ScaledInputs *inputs, double ahead) {
    return inputs->F_rss + ahead * inputs->F_rss_slope;
}
static inline double eta_pi_at(const ScaledInputs *inputs, double ahead) {
    return inputs->eta_pi + ahead * (inputs->eta_pi_slope + ahead * inputs->eta_pi_curve);
}
static inline double chi_pi_at(const ScaledInputs *inputs, double ahead) {
    return inputs->chi_pi + ahead * (inputs->chi_pi_slope + ahead * inputs->chi_pi_curve);
}
static inline double psi_star_at(const ScaledInputs *inputs, double ahead) {
    return inputs->psi_star + ahead * inputs->psi_star_slope;
}

/* Whether more of the inputs changes along the way than the force, so that the law is another from place to place. */
static inline int law_changes(const ScaledInputs *inputs) {
    return inputs->eta_pi_slope != 0 || inputs->chi_pi_slope != 0 || inputs->psi_star_slope != 0 ||
           inputs->eta_pi_curve != 0 || inputs->chi_pi_curve != 0;
}

/* Whether inputs change along the way. */
static inline int are_ramps(const ScaledInputs *inputs) { return inputs->F_rss_slope != 0 || law_changes(inputs); }

/* Let inputs be those a length `ahead` of where they were taken over. */
static inline void go_ahead(ScaledInputs *inputs, double ahead) {
    if (!are_ramps(inputs)) return;
    inputs->F_rss = F_rss_at(inputs, ahead), inputs->psi_star = psi_star_at(inputs, ahead);
    inputs->eta_pi = eta_pi_at(inputs, ahead), inputs->eta_pi_slope += 2 * ahead * inputs->eta_pi_curve;
    inputs->chi_pi = chi_pi_at(inputs, ahead), inputs->chi_pi_slope += 2 * ahead * inputs->chi_pi_curve;
}

/* The inputs there. */
static inline ScaledInputs inputs_ahead(const ScaledInputs *inputs, double ahead) {
    ScaledInputs there = *inputs;
    go_ahead(&there, ahead);
    return there;
}

/* ε = χ/η. */
static inline double epsilon(const ScaledInputs *inputs) { return inputs->chi_pi / inputs->eta_pi; }

/* Whether the pads aim at another side, or the bit walks otherwise. */
static inline int aims_anew(const ScaledInputs *inputs, const ScaledInputs *before) {
#ifdef SPACE
    return inputs->toolface != before->toolface || inputs->reference != before->reference ||
           inputs->walk != before->walk;
#else
    (void)inputs, (void)before;
    return 0;
#endif
}

/* Whether the law is another, which the force alone does not make it. */
static inline int changes_law(const ScaledInputs *inputs, const ScaledInputs *before) {
    return inputs->eta_pi != before->eta_pi || inputs->chi_pi != before->chi_pi ||
           inputs->psi_star != before->psi_star || inputs->W != before->W || law_changes(inputs) || law_changes(before);
}

/* The largest share per ξ by which ηΠ, χΠ or ψ* changes, at first and at most on a short way. */
static inline double growth_of(const ScaledInputs *inputs) {
    double eta = fabs(inputs->eta_pi_slope / inputs->eta_pi), chi = fabs(inputs->chi_pi_slope / inputs->chi_pi);
    if (inputs->eta_pi_curve != 0) eta += sqrt(fabs(inputs->eta_pi_curve / inputs->eta_pi));
    if (inputs->chi_pi_curve != 0) chi += sqrt(fabs(inputs->chi_pi_curve / inputs->chi_pi));
    return larger(larger(eta, chi), fabs(inputs->psi_star_slope / inputs->psi_star));
}

#define SAME 1e-12 /* relative: what differs by less differs by rounding */

/* Whether ε is another, not by rounding. */
static inline int turns_anew(const ScaledInputs *inputs, const ScaledInputs *before) {
    return fabs(epsilon(inputs) - epsilon(before)) > SAME * epsilon(before);
}

/* Whether ramps of one value are the same along a way. */
static inline int same_ramp(
    double a, double a_slope, double a_curve, double b, double b_slope, double b_curve, double way
) {
    double end = b + way * (b_slope + way * b_curve);
    double off = fabs(a - b) + way * (fabs(a_slope - b_slope) + way * fabs(a_curve - b_curve));
    return off <= SAME * larger(fabs(b), fabs(end));
}

/* Whether two sets of inputs, of which one is a ramp, are the same along a way. */
static inline int same_ramps(const ScaledInputs *a, const ScaledInputs *b, double way) {
    return same_ramp(a->F_rss, a->F_rss_slope, 0.0, b->F_rss, b->F_rss_slope, 0.0, way) &&
           same_ramp(a->eta_pi, a->eta_pi_slope, a->eta_pi_curve, b->eta_pi, b->eta_pi_slope, b->eta_pi_curve, way) &&
           same_ramp(a->chi_pi, a->chi_pi_slope, a->chi_pi_curve, b->chi_pi, b->chi_pi_slope, b->chi_pi_curve, way) &&
           same_ramp(a->psi_star, a->psi_star_slope, 0.0, b->psi_star, b->psi_star_slope, 0.0, way);
}

/* λ_i: distance from stabilizer i−1 (the bit) to stabilizer i, counted from 0 here. */
static inline double lambda_(const Scaled *scaled, int i) { return scaled->s[i] - (i ? scaled->s[i - 1] : 0.0); }

/* The sections of the beam; a uniform beam is one. */
static inline void scale_sections(const System *system, Scaled *scaled) {
    double l1 = length_scale(system), end = 0.0;
    scaled->sections = system->structure.sections ? system->structure.sections : 1;
    for (int k = 0; k < scaled->sections; k++) {
        int given = system->structure.sections > 0;
        scaled->section_end[k] = end += given ? system->section_length[k] / l1 : scaled->s[scaled->n - 1];
        scaled->section_beta[k] = given ? system->section_flexural_stiffness[k] / system->flexural_stiffness : 1.0;
        scaled->section_w[k] =
            (given ? system->section_distributed_weight[k] : system->distributed_weight) * l1 / force_scale(system);
    }
    scaled->end_deflection = system->end_deflection / l1;
    scaled->axial = system->structure.axial, scaled->points = system->structure.points;
    scaled->uniform = !system->structure.sections && !scaled->axial;
    scaled->stepped = !scaled->uniform || scaled->points;
    for (int k = 0; k < scaled->points; k++) {
        scaled->s[scaled->n + k] = system->body_point_position[k] / l1;
        scaled->y_star[scaled->n + k] = system->body_point_clearance[k] / l1;
    }
}

/* The dimensionless numbers of a drilling system, section II of the paper. */
static inline Scaled scale(const System *system) {
    double l1 = length_scale(system);
    Scaled scaled = {0};
    scaled.n = system->structure.n;
    for (int i = 0; i < scaled.n; i++) scaled.s[i] = system->stabilizer_position[i] / l1;
    for (int i = 0; i < scaled.n - 1; i++) scaled.y_star[i] = system->stabilizer_clearance[i] / l1;
    scaled.Delta = system->rss_position / l1;
    scaled.w = system->distributed_weight * l1 / force_scale(system);
    scale_sections(system, &scaled);
    scaled.sensors = system->structure.sensors;
    for (int i = 0; i < scaled.sensors; i++) {
        Sensor sensor = {system->sensor_position[i] / l1, system->sensor_interval[i] / l1,
                         system->sensor_bias[i],          system->sensor_noise[i],
                         system->sensor_seed[i],          system->sensor_body_clearance[i] / l1};
        scaled.sensor[i] = sensor;
    }
    return scaled;
}

/* ηΠ, the active weight on bit (N) over F*, times the lateral steering resistance. */
static inline double eta_pi(const System *system, double lateral_steering_resistance, double active_weight_on_bit) {
    return lateral_steering_resistance * active_weight_on_bit / force_scale(system);
}

#endif
