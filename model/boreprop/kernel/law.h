/* The right-hand side of the propagation, mode by mode, as a linear function of the state and the delayed hole.

       εηΠ θ' = M ,   Y' = Θ = θ − ψ ,   ψ = clip(F_0/(ηΠ), −ψ*, ψ*)                                      (16), (17)

   with M and F_0 from the beam in the hole it drilled, e_i = Y(ξ) − Y(ξ−s_i) − s_i θ. Within a mode (which stabilizers
   touch which wall, tilt saturated or not) only sin⟨Θ⟩_1 is not linear. */
#ifndef BOREPROP_LAW_H
#define BOREPROP_LAW_H

#include "contact.h"
#include "radau.h"

/* The inputs from where they were taken over: F_RSS, its slope over ξ, and ηΠ. */
typedef struct {
    double F_rss, F_rss_slope, eta_pi;
} ScaledInputs;

/* A `Row` under given inputs, on the state:
   theta θ + Y Y + Σ_i delayed[i] Y(ξ−s_i) + g sin⟨Θ⟩_1 + one + slope (ξ − ξ of the inputs). */
typedef struct {
    double theta, Y, delayed[MAX_STABILIZERS], g, one, slope;
} Linear;

/* `scale` times `row`, with e_i = Y − Y(ξ−s_i) − s_i θ put in. */
static inline Linear make_linear(const Row *row, const Scaled *scaled, ScaledInputs inputs, double scale) {
    Linear linear = {0};
    for (int i = 0; i < scaled->n; i++) {
        linear.theta += row->e[i] * scaled->s[i];
        linear.Y += row->e[i];
        linear.delayed[i] = -scale * row->e[i];
    }
    linear.theta *= -scale, linear.Y *= scale;
    linear.g = scale * row->g;
    linear.one = scale * (row->rss * inputs.F_rss + row->one);
    linear.slope = scale * row->rss * inputs.F_rss_slope;
    return linear;
}

/* Value at one point, `ahead` of where the inputs were taken over. */
static inline double linear_at(
    const Linear *f, int n, double theta, double Y, const double *delayed, double sine, double ahead
) {
    double value = f->theta * theta + f->Y * Y + f->g * sine + f->one;
    for (int i = 0; i < n; i++) value += f->delayed[i] * delayed[i];
    return value + f->slope * ahead;
}

/* Add the parts of stabilizers 2 … n, and of a force that changes along the step. */
static inline void add_others(
    const Linear *f, int n, double delayed[][POINTS], const double *ahead, double values[POINTS]
) {
    for (int i = 1; i < n; i++)
        if (f->delayed[i] != 0)
            for (int k = 0; k < POINTS; k++) values[k] += f->delayed[i] * delayed[i][k];
    if (f->slope != 0)
        for (int k = 0; k < POINTS; k++) values[k] += f->slope * ahead[k];
}

/* Values along a step with (θ, Y) held; `delayed` has one list for each stabilizer. */
static inline void linear_held(
    const Linear *f, int n, double theta, double Y, double delayed[][POINTS], const double *sines, const double *ahead,
    double values[POINTS]
) {
    double state = f->theta * theta + f->Y * Y + f->one;
    for (int k = 0; k < POINTS; k++) values[k] = state + f->g * sines[k] + f->delayed[0] * delayed[0][k];
    add_others(f, n, delayed, ahead, values);
}

/* Values along a step; `delayed` has one list for each stabilizer. */
static inline void linear_along(
    const Linear *f, int n, const double *thetas, const double *Ys, double delayed[][POINTS], const double *sines,
    const double *ahead, double values[POINTS]
) {
    for (int k = 0; k < POINTS; k++)
        values[k] = f->one + f->theta * thetas[k] + f->Y * Ys[k] + f->delayed[0] * delayed[0][k] + f->g * sines[k];
    add_others(f, n, delayed, ahead, values);
}

/* What stays between `lower` and `upper` while a mode holds: of stabilizer `part`, or of the tilt (part n−1). */
typedef struct {
    int part;
    Linear value;
    double lower, upper;
} Bound;

/* The right-hand side in one mode under given inputs, and the bounds within which it holds. */
typedef struct {
    Linear theta_rate, Theta;
    double relaxation;
    int bound_count;
    Bound bounds[MAX_STABILIZERS];
    double gains[MAX_STABILIZERS]; /* change per change of Y(ξ−s_i): of Θ, θ having settled, or of what is bounded */
} Law;

static inline Law make_law(const Scaled *scaled, const Modes *modes, const Mode *mode, int tilt, ScaledInputs inputs) {
    int n = scaled->n;
    double psi_star = scaled->psi_star;
    Law law = {0};
    Linear psi = make_linear(&mode->F_0, scaled, inputs, 1 / inputs.eta_pi);
    law.theta_rate = make_linear(&mode->M, scaled, inputs, 1 / (scaled->epsilon * inputs.eta_pi));
    law.Theta.theta = 1.0;
    if (tilt) law.Theta.one = -tilt * psi_star;
    else {
        law.Theta.theta -= psi.theta, law.Theta.Y = -psi.Y, law.Theta.g = -psi.g, law.Theta.one = -psi.one;
        for (int i = 0; i < n; i++) law.Theta.delayed[i] = -psi.delayed[i];
        law.Theta.slope = -psi.slope;
    }
    law.relaxation = 1 / fabs(law.theta_rate.theta + law.Theta.Y);
    Bound tilt_bound = {n - 1, psi, -psi_star, psi_star};
    if (tilt > 0) tilt_bound.lower = psi_star, tilt_bound.upper = INFINITY;
    if (tilt < 0) tilt_bound.lower = -INFINITY, tilt_bound.upper = -psi_star;
    law.bounds[law.bound_count++] = tilt_bound;
    for (int i = 0; i < n - 1; i++) {
        Bound bound = {0};
        bound.part = i;
        const Row *row = mode_bounds(modes, mode, i, &bound.lower, &bound.upper);
        if (bound.lower == -INFINITY && bound.upper == INFINITY) continue;
        bound.value = make_linear(row, scaled, inputs, 1.0);
        law.bounds[law.bound_count++] = bound;
    }
    for (int i = 0; i < n; i++) {
        law.gains[i] = fabs(law.theta_rate.delayed[i] / law.theta_rate.theta) + fabs(law.Theta.delayed[i]);
        for (int k = 0; k < law.bound_count; k++)
            law.gains[i] = larger(law.gains[i], fabs(law.bounds[k].value.delayed[i]));
    }
    law.gains[0] += fabs(law.theta_rate.g / law.theta_rate.theta) + fabs(law.Theta.g);
    return law;
}

#endif
