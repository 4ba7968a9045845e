/* The planar law: the right-hand side of the propagation, regime by regime, as a linear function of the state and the
   delayed hole.

       εηΠ θ' = M ,   Y' = Θ = θ − ψ ,   ψ = clip(F_0/(ηΠ), −ψ*, ψ*)                                      (16), (17)

   with M and F_0 from the beam in the hole it drilled, e_i = Y(ξ) − Y(ξ−s_i) − s_i θ. Within a regime (which stabilizers
   touch which wall, tilt saturated or not) only the sine that goes with the weight is not linear, so one step is one
   linear solve of Radau collocation. It is that of ⟨Θ⟩_1; where the axial load counts, of θ.

   The integrator uses of a law `make_law`, `law_try`, `law_at`, `law_along` and `displacement`, and of a `Law` the
   relaxation length, the bounds and the gains; modes.h tells it which regime lies beyond a bound. */
#ifndef BOREPROP_LAW_H
#define BOREPROP_LAW_H

#include "modes.h"
#include "step.h"

/* A `Row` under given inputs, on the state:
   theta θ + Y Y + Σ_i delayed[i] Y(ξ−s_i) + g times the sine + constant + slope (ξ − ξ of the inputs). */
typedef struct {
    double theta, Y, g, constant, slope, delayed[MAX_PLACES];
} Linear;

/* `scale` times `row`, with e_i = Y − Y(ξ−s_i) − s_i θ put in. */
static inline void make_linear(
    Linear *linear, const Row *row, const Places *places, ScaledInputs inputs, double scale
) {
    linear->theta = linear->Y = 0.0;
    for (int i = 0; i < places->count; i++) {
        linear->theta += row->e[i] * places->s[i];
        linear->Y += row->e[i];
        linear->delayed[i] = -scale * row->e[i];
    }
    linear->theta *= -scale, linear->Y *= scale;
    linear->g = scale * row->g;
    linear->constant = scale * (row->rss * inputs.F_rss + row->constant);
    linear->slope = scale * row->rss * inputs.F_rss_slope;
}

/* While a regime holds, `value` lies between `lower` and `upper`: of the support at the place `part`, or of the tilt. */
typedef struct {
    int part;
    Linear value;
    double lower, upper;
} Bound;

/* By which share ηΠ, χΠ or ψ* changes within a step, at most: it then takes about six iterations. */
#define LONGEST_RAMP 0.1

/* The right-hand side in one regime under given inputs, and the bounds within which it holds. */
typedef struct {
    int count, last; /* of places, and that of the last stabilizer, which is the tilt's */
    int saturated;
    int stands;          /* the BHA does not buckle between its contacts */
    int axial;           /* whether the sine is that of θ */
    int changes;         /* along the way, since its inputs do */
    ScaledInputs inputs; /* under which it was made, and … */
    double inputs_xi;    /* … where they are these */
    double longest;      /* step of a law that changes */
    Linear theta_rate, Theta;
    double relaxation; /* length over which θ forgets */
    int bound_count;
    Bound bounds[MAX_PLACES];
    Gain gains[MAX_PLACES];
} Law;

/* Θ = θ − ψ, with ψ as it is without saturation. */
static inline void less_tilt(Linear *Theta, const Linear *psi, int count) {
    Theta->theta = 1.0 - psi->theta, Theta->Y = -psi->Y, Theta->g = -psi->g;
    Theta->constant = -psi->constant, Theta->slope = -psi->slope;
    for (int i = 0; i < count; i++) Theta->delayed[i] = -psi->delayed[i];
}

/* Θ = θ − ψ, with a ψ that is saturated on this side. */
static inline void less_limit(Linear *Theta, int side, ScaledInputs inputs, int count) {
    Theta->theta = 1.0, Theta->Y = Theta->g = 0.0;
    Theta->constant = -side * inputs.psi_star, Theta->slope = -side * inputs.psi_star_slope;
    for (int i = 0; i < count; i++) Theta->delayed[i] = 0.0;
}

/* As gains of either kind the change of Θ, once θ has followed, or that of a bounded value if it is larger. */
static inline void find_gains(Law *law) {
    for (int i = 0; i < law->count; i++) {
        double gain = fabs(law->theta_rate.delayed[i] / law->theta_rate.theta) + fabs(law->Theta.delayed[i]);
        for (int k = 0; k < law->bound_count; k++) gain = larger(gain, fabs(law->bounds[k].value.delayed[i]));
        if (i == 0 && !law->axial) gain += fabs(law->theta_rate.g / law->theta_rate.theta) + fabs(law->Theta.g);
        law->gains[i].theta = law->gains[i].Theta = gain;
    }
}

/* Make the law of a regime under inputs taken over at `inputs_xi`. */
static inline void make_law(
    Law *law, const Scaled *scaled, const Places *places, Modes *modes, Regime regime, ScaledInputs inputs,
    double inputs_xi
) {
    const Mode *mode = mode_of(modes, &regime.contact);
    int n = scaled->n, count = places->count;
    Bound *of_tilt = &law->bounds[0];
    law->count = count, law->last = n - 1, law->axial = scaled->axial, law->inputs_xi = inputs_xi, law->bound_count = 1;
    law->saturated = regime.saturation != 0, law->stands = mode->stands;
    law->inputs = inputs, law->changes = law_changes(&inputs);
    law->longest = law->changes ? LONGEST_RAMP / growth_of(&inputs) : INFINITY;
    make_linear(&law->theta_rate, &mode->M, places, inputs, 1 / inputs.chi_pi);
    of_tilt->part = n - 1;
    make_linear(&of_tilt->value, &mode->F_0, places, inputs, 1 / inputs.eta_pi);
    saturation_bounds(regime.saturation, inputs.psi_star, &of_tilt->lower, &of_tilt->upper);
    if (regime.saturation) less_limit(&law->Theta, regime.saturation, inputs, count);
    else less_tilt(&law->Theta, &of_tilt->value, count);
    law->relaxation = 1 / fabs(law->theta_rate.theta + law->Theta.Y);
    for (int i = 0; i < count; i++) {
        Bound *bound = &law->bounds[law->bound_count];
        if (i == n - 1) continue;
        const Row *row = contact_bounds(modes, mode, i, &bound->lower, &bound->upper);
        if (bound->lower == -INFINITY && bound->upper == INFINITY) continue;
        bound->part = i;
        make_linear(&bound->value, row, places, inputs, 1.0);
        law->bound_count++;
    }
    find_gains(law);
}

/* By what F_0/(ηΠ), as under the inputs of a law that changes, is multiplied a length `ahead` of where they were taken
   over, to be bounded there as well by the ψ* of these: by their ηΠψ* over that ahead. */
APART static double tilt_ratio(const Law *law, double ahead) {
    const ScaledInputs *own = &law->inputs;
    return own->eta_pi * own->psi_star / (eta_pi_at(own, ahead) * psi_star_at(own, ahead));
}

/* Whether a bounded value is to be multiplied by it. */
static inline int is_on_ramp(const Law *law, const Bound *bound) { return law->changes && bound->part == law->last; }

/* A bounded value at one place of a trial step. */
static inline double law_at(
    const Law *law, const Bound *bound, const Trial *trial, double xi, const double x[COMPONENTS],
    double delayed[][DIRECTIONS]
) {
    const Linear *f = &bound->value;
    (void)trial;
    double sine = sin(law->axial ? x[ANGLE] : x[LATERAL] - delayed[0][0]);
    double value = f->theta * x[ANGLE] + f->Y * x[LATERAL] + f->g * sine + f->constant;
    for (int i = 0; i < law->count; i++) value += f->delayed[i] * delayed[i][0];
    value += f->slope * (xi - law->inputs_xi);
    return is_on_ramp(law, bound) ? value * tilt_ratio(law, xi - law->inputs_xi) : value;
}

/* Add the terms of all places but the first, and that of a force which changes along the step. */
static inline void add_others(const Linear *f, int count, const Trial *trial, double values[restrict POINTS]) {
    for (int i = 1; i < count; i++)
        if (f->delayed[i] != 0)
            for (int k = 0; k < POINTS; k++) values[k] += f->delayed[i] * trial->delayed[i][0][k];
    if (f->slope != 0)
        for (int k = 0; k < POINTS; k++) values[k] += f->slope * trial->ahead[k];
}

/* The values of a row at the points of a trial step, by the ηΠ and χΠ where the law was made. */
APART static void linear_along(const Linear *f, int count, const Trial *trial, double values[restrict POINTS]) {
    const double *theta = trial->x[ANGLE], *Y = trial->x[LATERAL], *Y_1 = trial->delayed[0][0];
    for (int k = 0; k < POINTS; k++)
        values[k] = f->constant + f->theta * theta[k] + f->Y * Y[k] + f->delayed[0] * Y_1[k] + f->g * trial->sines[k];
    add_others(f, count, trial, values);
}

/* A bounded value at the points of a trial step. */
static inline void law_along(const Law *law, const Bound *bound, const Trial *trial, double values[POINTS]) {
    linear_along(&bound->value, law->count, trial, values);
    if (!is_on_ramp(law, bound)) return;
    for (int k = 0; k < POINTS; k++) values[k] *= tilt_ratio(law, trial->ahead[k]);
}

/* The same of a part of the right-hand side, with (θ, Y) frozen at the start of the step. */
static inline void linear_frozen(
    const Linear *f, int count, const double x[COMPONENTS], const Trial *trial, const double sines[POINTS],
    double values[restrict POINTS]
) {
    double state = f->theta * x[ANGLE] + f->Y * x[LATERAL] + f->constant;
    for (int k = 0; k < POINTS; k++) values[k] = state + f->g * sines[k] + f->delayed[0] * trial->delayed[0][0][k];
    add_others(f, count, trial, values);
}

#define REST 0.03       /* what may be neglected of the sine, in tolerances of θ: little beside the error of a step */
#define LESS_REST 0.003 /* the same where kinks are many: steps that pass them leave no room for more */
#define ITERATIONS 10   /* on what is neglected, at most; each gains two digits or more */

/* The sine about its value at an angle `from`, which is part ANGLE or LATERAL of the state, less what is `behind` at the
   points of the step, so that it is θ or ⟨Θ⟩_1 = Y(ξ) − Y(ξ−1). */
typedef struct {
    int part;
    const double *behind;
    double from, sine, cosine;
} Tangent;

enum { MIDDLE = 2 }; /* the point next to the middle of a step */

/* The tangent at the start of a step. In a step that follows on the last one it is at its middle, if it goes straight on: the
   sine is half as far from it. */
static inline Tangent tangent_of(const Law *law, const Step *last, const double x[COMPONENTS], const Trial *trial) {
    static const double nothing[POINTS] = {0};
    int part = law->axial ? ANGLE : LATERAL;
    const double *behind = law->axial ? nothing : trial->delayed[0][0];
    double from = x[part] - behind[0];
    if (trial->follows) {
        double way = polynomial_slope(last->x[part], (last->end - last->xi) / last->h) * trial->step.h / last->h;
        from = x[part] + way * POINT[MIDDLE] - behind[MIDDLE];
    }
    Tangent tangent = {part, behind, from, sin(from), cos(from)};
    return tangent;
}

/* The sines at the points of a step that was solved from the state `x` with `frozen` sines. Returns whether these agree
   well enough; if they do not, `frozen` becomes better ones, less the linear part, which belongs to the Jacobian. */
static inline int sines_agree(
    Tangent tangent, const double x[COMPONENTS], double gain, double allowed, Trial *trial, double frozen[POINTS]
) {
    const double *at = trial->x[tangent.part], *behind = tangent.behind, start = x[tangent.part];
    double far = 0.0, largest = 0.0, away[POINTS];
    for (int k = 0; k < POINTS; k++) away[k] = at[k] - behind[k] - tangent.from, far = larger(far, fabs(away[k]));
    for (int k = 0; k < POINTS; k++) trial->sines[k] = tangent.sine + tangent.cosine * away[k];
    if (far * far / 2 * gain <= allowed) return 1; /* |sin(a + d) − sin a − d cos a| <= d²/2 */
    for (int k = 0; k < POINTS; k++) {
        double assumed = frozen[k] + tangent.cosine * (at[k] - start);
        trial->sines[k] = sin(at[k] - behind[k]);
        frozen[k] += trial->sines[k] - assumed;
        largest = larger(largest, fabs(trial->sines[k] - assumed));
    }
    return largest * gain <= allowed;
}

/* The sines at the points of a trial step. */
static inline void sines_along(const Law *law, Trial *trial) {
    const double *theta = trial->x[ANGLE], *Y = trial->x[LATERAL], *Y_1 = trial->delayed[0][0];
    for (int k = 0; k < POINTS; k++) trial->sines[k] = sin(law->axial ? theta[k] : Y[k] - Y_1[k]);
}

/* Of a law that changes, by what M/χΠ and F_0/(ηΠ) as under its inputs are multiplied at the points of a trial step. */
typedef struct {
    double M[POINTS], F_0[POINTS];
} Ratios;

static inline Ratios ratios_along(const Law *law, const Trial *trial) {
    const ScaledInputs *own = &law->inputs;
    Ratios ratios;
    for (int k = 0; k < POINTS; k++) {
        ratios.M[k] = own->chi_pi / chi_pi_at(own, trial->ahead[k]);
        ratios.F_0[k] = law->saturated ? 1.0 : own->eta_pi / eta_pi_at(own, trial->ahead[k]);
    }
    return ratios;
}

/* θ' and Y' at the points of a trial step of a law that changes. */
static inline void rates_along(
    const Law *law, const Ratios *ratios, const Trial *trial, double theta_rate[POINTS], double Theta[POINTS]
) {
    const double *theta = trial->x[ANGLE];
    linear_along(&law->theta_rate, law->count, trial, theta_rate);
    linear_along(&law->Theta, law->count, trial, Theta);
    for (int k = 0; k < POINTS; k++) {
        theta_rate[k] *= ratios->M[k];
        Theta[k] = theta[k] + ratios->F_0[k] * (Theta[k] - theta[k]);
    }
}

#define RAMP_ITERATIONS 20 /* at most; each gains a digit or more */

/* Collocation of a law that changes: what the Jacobian, which is that at the start, neglects is added to the right-hand
   side until it is small. Returns whether it is; gives the right-hand side with the state frozen, and the parts. */
APART static int collocate_on_ramp(
    const Law *law, const Options *options, const double x[COMPONENTS], Jacobian J, Trial *trial,
    double f_theta[POINTS], double f_Y[POINTS], double parts_theta[S], double parts_Y[S]
) {
    double h = trial->step.h, *theta = trial->x[ANGLE], *Y = trial->x[LATERAL];
    double rate[POINTS], Theta[POINTS], allowed = REST * options->relative_tolerance;
    Ratios ratios = ratios_along(law, trial);
    for (int k = 0; k < POINTS; k++) theta[k] = x[ANGLE], Y[k] = x[LATERAL];
    sines_along(law, trial);
    rates_along(law, &ratios, trial, f_theta, f_Y);
    for (int iteration = 0; iteration < RAMP_ITERATIONS; iteration++) {
        double off_theta = 0.0, off_Y = 0.0;
        collocate(h, J, f_theta, f_Y, parts_theta, parts_Y);
        radau_values(x[ANGLE], parts_theta, theta);
        radau_values(x[LATERAL], parts_Y, Y);
        sines_along(law, trial);
        rates_along(law, &ratios, trial, rate, Theta);
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

/* Collocation from the state `x` over a trial step, whose place, length and delayed hole are given; the last step is for
   laws that need a guess. */
static inline void law_try(
    const Law *law, const Options *options, const Step *last, const double x[COMPONENTS], Trial *trial
) {
    const Linear *rate = &law->theta_rate, *Theta = &law->Theta;
    const double theta = x[ANGLE], Y = x[LATERAL], h = trial->step.h;
    double frozen[POINTS], f_theta[POINTS], f_Y[POINTS], parts_theta[S], parts_Y[S];
    Tangent tangent = tangent_of(law, last, x, trial);
    Jacobian J = {rate->theta, rate->Y, Theta->theta, Theta->Y};
    *(law->axial ? &J.theta_theta : &J.theta_Y) += rate->g * tangent.cosine;
    *(law->axial ? &J.Y_theta : &J.Y_Y) += Theta->g * tangent.cosine;
    double rest = trial->passes ? LESS_REST : REST;
    double allowed = rest * options->relative_tolerance * (fabs(rate->theta) + 1 / h);
    for (int k = 0; k < POINTS; k++) {
        trial->ahead[k] = trial->step.xi - law->inputs_xi + POINT[k] * h;
        frozen[k] = tangent.sine + tangent.cosine * (x[tangent.part] - tangent.behind[k] - tangent.from);
    }
    int ramp = law->changes;
    int found = ramp && collocate_on_ramp(law, options, x, J, trial, f_theta, f_Y, parts_theta, parts_Y);
    for (int iteration = 0; !ramp && iteration < ITERATIONS; iteration++) {
        linear_frozen(rate, law->count, x, trial, frozen, f_theta);
        linear_frozen(Theta, law->count, x, trial, frozen, f_Y);
        collocate(h, J, f_theta, f_Y, parts_theta, parts_Y);
        radau_values(Y, parts_Y, trial->x[LATERAL]);
        if (law->axial) radau_values(theta, parts_theta, trial->x[ANGLE]); /* of which the sine is then */
        if (sines_agree(tangent, x, fabs(rate->g), allowed, trial, frozen)) break;
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
        double turn = Theta[k] - Theta[1], node_sine = sine, node_cosine = cosine;
        if (k != 1 && fabs(turn) <= SMALL_TURN) turn_by(turn, sine, cosine, &node_sine, &node_cosine);
        else if (k != 1) node_sine = sin(Theta[k]), node_cosine = cos(Theta[k]);
        sideways += weights[k] * node_sine, down += weights[k] * node_cosine;
    }
    *x = sideways * length, *z = down * length;
}

/* The same as coordinates of a place: sideways and down. */
static inline void move_along(const Step *step, double xi, double path[AXES]) {
    double x, z;
    if (xi == step->xi) return;
    displacement(step, xi, &x, &z);
    path[0] += x, path[1] += z;
}

/* Let the path of the next step begin where the last one has led at `xi`. */
static inline void lead_on(const Step *last, double xi, Step *next) {
    memcpy(next->path, last->path, sizeof next->path);
    move_along(last, xi, next->path);
}

#define LARGEST_INCLINATION 6.283185307179586 /* beyond a full turn nothing is drilled */

/* Whether the bit, in the state `x` at the end of a trial step, has turned over. */
static inline int turns_over(const Law *law, const Trial *trial, const double x[COMPONENTS]) {
    (void)law, (void)trial;
    return !(fabs(x[ANGLE]) <= LARGEST_INCLINATION);
}

#endif
