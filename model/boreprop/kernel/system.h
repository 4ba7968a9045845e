/* The drilling system in SI units, and the paper's dimensionless numbers made from it. */
#ifndef BOREPROP_SYSTEM_H
#define BOREPROP_SYSTEM_H

#include "checks.h"
#include "quantities.h"

/* The drilling system in the paper's numbers: lengths over ℓ₁, forces over F*, moments over F*ℓ₁. */
typedef struct {
    int n;
    double s[MAX_STABILIZERS];          /* s_1 … s_n, distance of the stabilizers from the bit; s_1 = 1 */
    double y_star[MAX_STABILIZERS - 1]; /* y*_1 … y*_{n−1} */
    double Delta;                       /* distance of the RSS from the bit */
    double w;                           /* w̃ = w ℓ₁ / F* */
    double epsilon;                     /* ε = χ/η */
    double psi_star;                    /* ψ*, rad */
} Scaled;

/* How many values a quantity has for n stabilizers. */
static inline int value_count(Size size, int n) { return size == ONE ? 1 : size == EACH_STABILIZER ? n : n - 1; }

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
    int shown = quantity->size == ONE ? 0 : index + 1;
    return check_number(quantity->name, shown, value, quantity->above, quantity->at_least, quantity->at_most, problem);
}

/* The system of n stabilizers with these parameters, one after the other in the order of the table. Nothing is read for
   an n that `check_system` refuses. */
static inline System system_of(int n, const double *values) {
    System system = {0};
    system.n = n;
    for (int k = 0; k < PARAMETER_COUNT && n >= 1 && n <= MAX_STABILIZERS; k++) {
        int count = value_count(PARAMETER_TABLE[k].size, n);
        memcpy((char *)&system + PARAMETER_TABLE[k].offset, values, (size_t)count * sizeof *values);
        values += count;
    }
    return system;
}

static inline int check_system(const System *system, Problem *problem) {
    const double *positions = system->stabilizer_position;
    if (system->n < 1 || system->n > MAX_STABILIZERS)
        return wrong(problem, WRONG_COUNT, Q_STABILIZER_POSITION, 0, system->n, MAX_STABILIZERS);
    for (int k = 0; k < PARAMETER_COUNT; k++) {
        const Quantity *quantity = &PARAMETER_TABLE[k];
        const double *values = (const double *)(const void *)((const char *)system + quantity->offset);
        for (int i = 0; i < value_count(quantity->size, system->n); i++)
            if (!check_quantity(quantity, i, values[i], problem)) return 0;
    }
    return check_increasing(Q_STABILIZER_POSITION, system->n, positions, problem) &&
           check_spans(Q_STABILIZER_POSITION, system->n, positions, problem) &&
           check_at_most(Q_RSS_POSITION, system->rss_position, positions[0], problem);
}

/* ℓ₁, m: the distance from the bit to the first stabilizer. */
static inline double length_scale(const System *system) { return system->stabilizer_position[0]; }

/* F* = 3EI/ℓ₁², N. */
static inline double force_scale(const System *system) {
    return 3.0 * system->flexural_stiffness / (length_scale(system) * length_scale(system));
}

/* The inputs where they were taken over: F_RSS and ηΠ, and their changes per ξ. */
typedef struct {
    double F_rss, F_rss_slope, eta_pi, eta_pi_slope;
} ScaledInputs;

/* The inputs a length `ahead` of where they were taken over. */
static inline ScaledInputs inputs_ahead(ScaledInputs inputs, double ahead) {
    inputs.F_rss += inputs.F_rss_slope * ahead;
    inputs.eta_pi += inputs.eta_pi_slope * ahead;
    return inputs;
}

/* Whether inputs change along the way. */
static inline int are_ramps(const ScaledInputs *inputs) {
    return inputs->F_rss_slope != 0 || inputs->eta_pi_slope != 0;
}

#define SAME 1e-12 /* relative: ramps that differ by less at both ends of a way differ by rounding */

static inline int same_ramp(double a, double a_end, double b, double b_end) {
    double most = SAME * larger(fabs(b), fabs(b_end));
    return fabs(a - b) <= most && fabs(a_end - b_end) <= most;
}

/* Whether two pairs of inputs, of which one is a ramp, are the same along a way. */
static inline int same_ramps(ScaledInputs a, ScaledInputs b, double way) {
    ScaledInputs a_end = inputs_ahead(a, way), b_end = inputs_ahead(b, way);
    return same_ramp(a.F_rss, a_end.F_rss, b.F_rss, b_end.F_rss) &&
           same_ramp(a.eta_pi, a_end.eta_pi, b.eta_pi, b_end.eta_pi);
}

/* λ_i: distance from stabilizer i−1 (the bit) to stabilizer i, counted from 0 here. */
static inline double lambda_(const Scaled *scaled, int i) { return scaled->s[i] - (i ? scaled->s[i - 1] : 0.0); }

/* The dimensionless numbers of a drilling system, section II of the paper. */
static inline Scaled scale(const System *system) {
    double l1 = length_scale(system);
    Scaled scaled = {0};
    scaled.n = system->n;
    for (int i = 0; i < system->n; i++) scaled.s[i] = system->stabilizer_position[i] / l1;
    for (int i = 0; i < system->n - 1; i++) scaled.y_star[i] = system->stabilizer_clearance[i] / l1;
    scaled.Delta = system->rss_position / l1;
    scaled.w = system->distributed_weight * l1 / force_scale(system);
    scaled.epsilon = system->angular_steering_resistance / system->lateral_steering_resistance;
    scaled.psi_star = system->bit_tilt_limit;
    return scaled;
}

/* ηΠ, the active weight on bit (N) over F*, times the lateral steering resistance. */
static inline double eta_pi(const System *system, double active_weight_on_bit) {
    return system->lateral_steering_resistance * active_weight_on_bit / force_scale(system);
}

#endif
