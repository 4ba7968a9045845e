/* The planar law: the right-hand side of the propagation, regime by regime, as a linear function of the state and the
   delayed hole.

       εηΠ θ' = M ,   Y' = Θ = θ − ψ ,   ψ = clip(F_0/(ηΠ), −ψ*, ψ*)                                      (16), (17)

   with M and F_0 from the beam in the hole it drilled, e_i = Y(ξ) − Y(ξ−s_i) − s_i θ. Within a regime (which stabilizers
   touch which wall, tilt saturated or not) only sin⟨Θ⟩_1 is not linear, so one step is one linear solve of Radau
   collocation.

   The integrator uses of a law `make_law`, `law_try`, `law_at`, `law_along` and `displacement`, and of a `Law` the
   relaxation length, the bounds and the gains; modes.h tells it which regime lies beyond a bound. */
#ifndef BOREPROP_LAW_H
#define BOREPROP_LAW_H

#include "modes.h"
#include "step.h"

/* A `Row` under given inputs, on the state:
   theta θ + Y Y + Σ_i delayed[i] Y(ξ−s_i) + g sin⟨Θ⟩_1 + constant + slope (ξ − ξ of the inputs). */
typedef struct {
    double theta, Y, delayed[MAX_STABILIZERS], g, constant, slope;
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
    linear.constant = scale * (row->rss * inputs.F_rss + row->constant);
    linear.slope = scale * row->rss * inputs.F_rss_slope;
    return linear;
}

/* While a regime holds, `value` lies between `lower` and `upper`: of stabilizer `part`, or of the tilt (part n−1). */
typedef struct {
    int part;
    Linear value;
    double lower, upper;
} Bound;

#define LONGEST_RAMP 0.1 /* by which share ηΠ changes within a step, at most: it then takes about six iterations */

/* The right-hand side in one regime under given inputs, and the bounds within which it holds. */
typedef struct {
    int n, saturated;
    double inputs_xi; /* where the inputs are those that it was made under */
    double growth;    /* of ηΠ per ξ, over ηΠ there */
    double longest;   /* step under a changing ηΠ */
    Linear theta_rate, Theta;
    double relaxation; /* length over which θ forgets */
    int bound_count;
    Bound bounds[MAX_STABILIZERS];
    /* per change of Y(ξ−s_i) the change of Θ, once θ has followed, or that of a bounded value if it is larger */
    double gains[MAX_STABILIZERS];
} Law;

/* Θ = θ − ψ, with ψ as it is without saturation. */
static inline Linear less_tilt(Linear psi, int n) {
    Linear Theta = {1.0 - psi.theta, -psi.Y, {0}, -psi.g, -psi.constant, -psi.slope};
    for (int i = 0; i < n; i++) Theta.delayed[i] = -psi.delayed[i];
    return Theta;
}

static inline Law make_law(const Scaled *scaled, Modes *modes, Regime regime, ScaledInputs inputs, double inputs_xi) {
    const Mode *mode = mode_of(modes, regime.contact);
    int n = scaled->n;
    Law law = {0};
    Linear psi = make_linear(&mode->F_0, scaled, inputs, 1 / inputs.eta_pi);
    Linear saturated = {1.0, 0.0, {0}, 0.0, -regime.saturation * scaled->psi_star, 0.0};
    law.n = n, law.saturated = regime.saturation != 0, law.inputs_xi = inputs_xi;
    law.growth = inputs.eta_pi_slope / inputs.eta_pi;
    law.longest = law.growth == 0 ? INFINITY : LONGEST_RAMP / fabs(law.growth);
    law.theta_rate = make_linear(&mode->M, scaled, inputs, 1 / (scaled->epsilon * inputs.eta_pi));
    law.Theta = regime.saturation ? saturated : less_tilt(psi, n);
    law.relaxation = 1 / fabs(law.theta_rate.theta + law.Theta.Y);
    Bound of_tilt = {n - 1, psi, 0.0, 0.0};
    saturation_bounds(regime.saturation, scaled->psi_star, &of_tilt.lower, &of_tilt.upper);
    law.bounds[law.bound_count++] = of_tilt;
    for (int i = 0; i < n - 1; i++) {
        Bound *bound = &law.bounds[law.bound_count];
        const Row *row = contact_bounds(modes, mode, i, &bound->lower, &bound->upper);
        if (bound->lower == -INFINITY && bound->upper == INFINITY) continue;
        bound->part = i, bound->value = make_linear(row, scaled, inputs, 1.0);
        law.bound_count++;
    }
    for (int i = 0; i < n; i++) {
        law.gains[i] = fabs(law.theta_rate.delayed[i] / law.theta_rate.theta) + fabs(law.Theta.delayed[i]);
        for (int k = 0; k < law.bound_count; k++)
            law.gains[i] = larger(law.gains[i], fabs(law.bounds[k].value.delayed[i]));
    }
    law.gains[0] += fabs(law.theta_rate.g / law.theta_rate.theta) + fabs(law.Theta.g);
    return law;
}

/* ηΠ where a law was made over that a length `ahead` of there. M and F_0 are divided by ηΠ. */
static inline double eta_pi_ratio(const Law *law, double ahead) { return 1 / (1 + law->growth * ahead); }

/* A bounded value at one place. */
static inline double law_at(
    const Law *law, const Bound *bound, double xi, const double x[COMPONENTS], double delayed[][DIRECTIONS]
) {
    const Linear *f = &bound->value;
    double sine = sin(x[LATERAL] - delayed[0][0]);
    double value = f->theta * x[ANGLE] + f->Y * x[LATERAL] + f->g * sine + f->constant;
    for (int i = 0; i < law->n; i++) value += f->delayed[i] * delayed[i][0];
    value += f->slope * (xi - law->inputs_xi);
    return law->growth != 0 && bound->part == law->n - 1 ? value * eta_pi_ratio(law, xi - law->inputs_xi) : value;
}

/* Add the terms of stabilizers 2 … n, and that of a force which changes along the step. */
static inline void add_others(const Linear *f, int n, const Trial *trial, double values[POINTS]) {
    for (int i = 1; i < n; i++)
        if (f->delayed[i] != 0)
            for (int k = 0; k < POINTS; k++) values[k] += f->delayed[i] * trial->delayed[i][0][k];
    if (f->slope != 0)
        for (int k = 0; k < POINTS; k++) values[k] += f->slope * trial->ahead[k];
}

/* The values of a row at the points of a trial step, by the ηΠ where the law was made. */
static inline void linear_along(const Linear *f, int n, const Trial *trial, double values[POINTS]) {
    const double *theta = trial->x[ANGLE], *Y = trial->x[LATERAL], *Y_1 = trial->delayed[0][0];
    for (int k = 0; k < POINTS; k++)
        values[k] = f->constant + f->theta * theta[k] + f->Y * Y[k] + f->delayed[0] * Y_1[k] + f->g * trial->sines[k];
    add_others(f, n, trial, values);
}

/* A bounded value at the points of a trial step. */
static inline void law_along(const Law *law, const Bound *bound, const Trial *trial, double values[POINTS]) {
    linear_along(&bound->value, law->n, trial, values);
    if (law->growth == 0 || bound->part != law->n - 1) return;
    for (int k = 0; k < POINTS; k++) values[k] *= eta_pi_ratio(law, trial->ahead[k]);
}

/* The same of a part of the right-hand side, with (θ, Y) frozen at the start of the step. */
static inline void linear_frozen(
    const Linear *f, int n, const double x[COMPONENTS], const Trial *trial, const double sines[POINTS],
    double values[POINTS]
) {
    double state = f->theta * x[ANGLE] + f->Y * x[LATERAL] + f->constant;
    for (int k = 0; k < POINTS; k++) values[k] = state + f->g * sines[k] + f->delayed[0] * trial->delayed[0][0][k];
    add_others(f, n, trial, values);
}

#define REST 0.03     /* what may be neglected of sin⟨Θ⟩_1, in tolerances of θ: little beside the error of a step */
#define ITERATIONS 10 /* on what is neglected, at most; each gains two digits or more */

/* sin⟨Θ⟩_1 about its value at the start of a step, where ⟨Θ⟩_1 = Y(ξ) − Y(ξ−1) is `average`. */
typedef struct {
    double average, sine, cosine;
} Tangent;

/* The sines of ⟨Θ⟩_1 at the points of a step that was solved with `frozen` sines. Returns whether these agree well
   enough; if they do not, `frozen` becomes better ones, less the linear part in Y, which belongs to the Jacobian. */
static inline int sines_agree(
    Tangent tangent, double Y, double gain, double allowed, Trial *trial, double frozen[POINTS]
) {
    const double *Ys = trial->x[LATERAL], *Y_1 = trial->delayed[0][0];
    double far = 0.0, largest = 0.0;
    for (int k = 0; k < POINTS; k++) {
        double away = Ys[k] - Y_1[k] - tangent.average;
        trial->sines[k] = tangent.sine + tangent.cosine * away;
        far = larger(far, fabs(away));
    }
    if (far * far / 2 * gain <= allowed) return 1; /* |sin(a + d) − sin a − d cos a| <= d²/2 */
    for (int k = 0; k < POINTS; k++) {
        double assumed = frozen[k] + tangent.cosine * (Ys[k] - Y);
        trial->sines[k] = sin(Ys[k] - Y_1[k]);
        frozen[k] += trial->sines[k] - assumed;
        largest = larger(largest, fabs(trial->sines[k] - assumed));
    }
    return largest * gain <= allowed;
}

/* θ' and Y' at the points of a trial step under a changing ηΠ. */
static inline void rates_along(const Law *law, const Trial *trial, double theta_rate[POINTS], double Theta[POINTS]) {
    const double *theta = trial->x[ANGLE];
    linear_along(&law->theta_rate, law->n, trial, theta_rate);
    linear_along(&law->Theta, law->n, trial, Theta);
    for (int k = 0; k < POINTS; k++) {
        double ratio = eta_pi_ratio(law, trial->ahead[k]);
        theta_rate[k] *= ratio;
        if (!law->saturated) Theta[k] = theta[k] + ratio * (Theta[k] - theta[k]);
    }
}

/* A function that is seldom called: inlined, it would slow down what is. */
#ifdef __GNUC__
#define APART __attribute__((noinline))
#else
#define APART
#endif

#define RAMP_ITERATIONS 20 /* at most; each gains a digit or more */

/* Collocation under a changing ηΠ: what the Jacobian, which is that at the start, neglects is added to the right-hand
   side until it is small. Returns whether it is; gives the right-hand side with the state frozen, and the parts. */
APART static int collocate_on_ramp(
    const Law *law, const Options *options, const double x[COMPONENTS], Jacobian J, Trial *trial,
    double f_theta[POINTS], double f_Y[POINTS], double parts_theta[S], double parts_Y[S]
) {
    double h = trial->step.h, *theta = trial->x[ANGLE], *Y = trial->x[LATERAL], *Y_1 = trial->delayed[0][0];
    double rate[POINTS], Theta[POINTS], allowed = REST * options->relative_tolerance;
    for (int k = 0; k < POINTS; k++) theta[k] = x[ANGLE], Y[k] = x[LATERAL], trial->sines[k] = sin(Y[k] - Y_1[k]);
    rates_along(law, trial, f_theta, f_Y);
    for (int iteration = 0; iteration < RAMP_ITERATIONS; iteration++) {
        double off_theta = 0.0, off_Y = 0.0;
        collocate(h, J, f_theta, f_Y, parts_theta, parts_Y);
        radau_values(x[ANGLE], parts_theta, theta);
        radau_values(x[LATERAL], parts_Y, Y);
        for (int k = 0; k < POINTS; k++) trial->sines[k] = sin(Y[k] - Y_1[k]);
        rates_along(law, trial, rate, Theta);
        for (int k = 0; k < POINTS; k++) {
            double moved_theta = theta[k] - x[ANGLE], moved_Y = Y[k] - x[LATERAL];
            rate[k] -= f_theta[k] + J.theta_theta * moved_theta + J.theta_Y * moved_Y;
            Theta[k] -= f_Y[k] + J.Y_theta * moved_theta + J.Y_Y * moved_Y;
            off_theta = larger(off_theta, fabs(rate[k])), off_Y = larger(off_Y, fabs(Theta[k]));
        }
        if (off_theta <= allowed * (fabs(law->theta_rate.theta) + 1 / h) && off_Y <= allowed / h) return 1;
        for (int k = 0; k < POINTS; k++) f_theta[k] += rate[k], f_Y[k] += Theta[k];
    }
    return 0;
}

/* Collocation from the state `x` over a trial step, whose place, length and delayed hole are given. */
static inline void law_try(const Law *law, const Options *options, const double x[COMPONENTS], Trial *trial) {
    const Linear *rate = &law->theta_rate, *Theta = &law->Theta;
    const double theta = x[ANGLE], Y = x[LATERAL], h = trial->step.h, *Y_1 = trial->delayed[0][0];
    double frozen[POINTS], f_theta[POINTS], f_Y[POINTS], parts_theta[S], parts_Y[S];
    Tangent tangent = {Y - Y_1[0], sin(Y - Y_1[0]), cos(Y - Y_1[0])};
    Jacobian J = {rate->theta, rate->Y + rate->g * tangent.cosine, Theta->theta, Theta->Y + Theta->g * tangent.cosine};
    double allowed = REST * options->relative_tolerance * (fabs(rate->theta) + 1 / h);
    for (int k = 0; k < POINTS; k++) {
        trial->ahead[k] = trial->step.xi - law->inputs_xi + POINT[k] * h;
        frozen[k] = tangent.sine + tangent.cosine * (Y - Y_1[k] - tangent.average);
    }
    int ramp = law->growth != 0;
    int found = ramp && collocate_on_ramp(law, options, x, J, trial, f_theta, f_Y, parts_theta, parts_Y);
    for (int iteration = 0; !ramp && iteration < ITERATIONS; iteration++) {
        linear_frozen(rate, law->n, x, trial, frozen, f_theta);
        linear_frozen(Theta, law->n, x, trial, frozen, f_Y);
        collocate(h, J, f_theta, f_Y, parts_theta, parts_Y);
        radau_values(Y, parts_Y, trial->x[LATERAL]);
        if (sines_agree(tangent, Y, fabs(rate->g), allowed, trial, frozen)) break;
    }
    radau_values(theta, parts_theta, trial->x[ANGLE]);
    radau_coefficients(theta, parts_theta, trial->step.x[ANGLE]);
    radau_coefficients(Y, parts_Y, trial->step.x[LATERAL]);
    double moved_theta = trial->x[ANGLE][AT_CHECK] - theta, moved_Y = trial->x[LATERAL][AT_CHECK] - Y;
    double slope_theta = f_theta[AT_CHECK] + J.theta_theta * moved_theta + J.theta_Y * moved_Y;
    double slope_Y = f_Y[AT_CHECK] + J.Y_theta * moved_theta + J.Y_Y * moved_Y, error_theta, error_Y;
    radau_error(
        h, J, radau_slope(parts_theta) - h * slope_theta, radau_slope(parts_Y) - h * slope_Y, &error_theta, &error_Y
    );
    trial->error = larger(options->theta_weight * fabs(error_theta), fabs(error_Y)) / options->relative_tolerance;
    if (ramp && !found) trial->error = larger(trial->error, 2.0); /* tried again, shorter */
}

#define SMALL_TURN 0.05 /* rad: up to here the series below are off by less than 1e-15 */

/* Sine and cosine of an angle that is larger by a small `turn` than the one whose sine and cosine are given. */
static inline void turn_by(double turn, double sine, double cosine, double *new_sine, double *new_cosine) {
    double square = turn * turn;
    double s = turn * (1 - square / 6 * (1 - square / 20 * (1 - square / 42)));
    double c = 1 - square / 2 * (1 - square / 12 * (1 - square / 30));
    *new_sine = sine * c + cosine * s, *new_cosine = cosine * c - sine * s;
}

/* ∫ sin Θ dξ and ∫ cos Θ dξ from the start of the step to `xi`, by Gauss's three points. */
static inline void displacement(const Step *step, double xi, double *x, double *z) {
    double nodes[3] = {0.5 - sqrt(0.15), 0.5, 0.5 + sqrt(0.15)}, weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double length = xi - step->xi, sideways = 0.0, down = 0.0, Theta[3];
    for (int k = 0; k < 3; k++) Theta[k] = polynomial_slope(step->x[LATERAL], nodes[k] * length / step->h) / step->h;
    double sine = sin(Theta[1]), cosine = cos(Theta[1]);
    for (int k = 0; k < 3; k++) {
        double turn = Theta[k] - Theta[1], node_sine, node_cosine;
        if (fabs(turn) <= SMALL_TURN) turn_by(turn, sine, cosine, &node_sine, &node_cosine);
        else node_sine = sin(Theta[k]), node_cosine = cos(Theta[k]);
        sideways += weights[k] * node_sine, down += weights[k] * node_cosine;
    }
    *x = sideways * length, *z = down * length;
}

#endif
