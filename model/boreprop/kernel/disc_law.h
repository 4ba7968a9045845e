/* The law in space: the planar one in two directions across the bit's axis, which are those of its frame,

       εηΠ θ⃗' = M⃗ ,   Y⃗' = Θ⃗ = θ⃗ − ψ⃗

   with contacts and a bit tilt that are bounded by discs, the weight and the pads by the frame. Within a regime (which
   stabilizers touch, tilt saturated or not) the right-hand side is smooth, and a step of Radau collocation is solved by
   Newton's method. */
#ifndef BOREPROP_DISC_LAW_H
#define BOREPROP_DISC_LAW_H

#include "cone.h"
#include "sides.h"
#include "step.h"

/* A row of the beam without contacts on the state, in either direction:
   theta θ + Y Y + Σ_i delayed[i] Y(ξ−s_i) + g G + rss F_RSS + end times the high side. */
typedef struct {
    double theta, Y, g, rss, end, delayed[MAX_PLACES];
} Linear;

static inline Linear linear_of(const Row *row, const Places *places) {
    Linear linear = {.g = row->g, .rss = row->rss, .end = row->constant};
    for (int i = 0; i < places->count; i++) {
        linear.theta -= row->e[i] * places->s[i], linear.Y += row->e[i];
        linear.delayed[i] = -row->e[i];
    }
    return linear;
}

/* While a regime holds, a value lies between `lower` and `upper`: of the support at the place `part`, |v| − y* in contact, where it
   is k times the force, else |δ|; of the tilt, |F_0|/(ηΠ). */
typedef struct {
    int part;
    double lower, upper;
} Bound;

#define LONGEST_RAMP 0.1 /* by which share ηΠ, χΠ or ψ* changes within a step, at most */

/* The right-hand side in one regime under given inputs, and the bounds within which it holds. */
typedef struct {
    int count, n, saturated, axial, stands, changes;
    const Modes *modes;
    Contact contact;
    double s_n, y_star[MAX_PLACES], walk_cosine, walk_sine, toolface_cosine, toolface_sine;
    ScaledInputs inputs;
    double inputs_xi; /* where the inputs are those that it was made under */
    double longest;   /* step of a law that changes */
    double finest;    /* of the clearances, but those of zero */
    Touching touching;
    Linear q[MAX_PLACES], M, F_0; /* without contacts */
    double relaxation;
    int bound_count;
    Bound bounds[MAX_PLACES];
    Gain gains[MAX_PLACES];
} Law;

/* The gains and the length over which θ forgets: those of a planar hole in which the same stabilizers touch. A saturated tilt
   has that of a free one, which it may become. */
static inline void find_gains(Law *law, const Mode *mode, const Places *places) {
    double eta_pi = law->inputs.eta_pi, rate = 1 / law->inputs.chi_pi;
    Linear M = linear_of(&mode->M, places), F_0 = linear_of(&mode->F_0, places);
    double k_i[MAX_PLACES] = {0};
    for (int k = 0; k < law->touching.touching; k++) k_i[law->touching.C[k]] = law->touching.k[k];
    law->relaxation = 1 / fabs(rate * M.theta - (law->saturated ? 0.0 : F_0.Y / eta_pi));
    for (int i = 0; i < law->count; i++) {
        Gain *gain = &law->gains[i];
        gain->theta = fabs(M.delayed[i] / M.theta), gain->Theta = fabs(F_0.delayed[i]) / eta_pi;
        for (int k = 0; k < law->count; k++) {
            if (k == law->n - 1) continue;
            Linear delta = linear_of(&mode->delta[k], places), F = linear_of(&mode->F[k], places);
            gain->theta = larger(gain->theta, larger(fabs(delta.delayed[i]), k_i[k] * fabs(F.delayed[i])));
        }
    }
    if (!law->axial) law->gains[0].theta += fabs(M.g / M.theta), law->gains[0].Theta += fabs(F_0.g) / eta_pi;
}

static inline void add_bound(Law *law, int part, double lower, double upper) {
    Bound bound = {part, lower, upper};
    law->bounds[law->bound_count++] = bound;
}

/* Make the law of a regime under inputs taken over at `inputs_xi`. */
static inline void make_law(
    Law *law, const Scaled *scaled, const Places *places, Modes *modes, Regime regime, ScaledInputs inputs,
    double inputs_xi
) {
    Contact nothing = regime.contact;
    memset(nothing.of, 0, sizeof nothing.of);
    const Mode *mode = mode_of(modes, &nothing);
    int n = scaled->n;
    law->count = places->count, law->n = n, law->axial = scaled->axial, law->saturated = regime.saturation != 0;
    law->stands = mode->stands;
    law->modes = modes, law->contact = regime.contact, law->inputs = inputs, law->inputs_xi = inputs_xi,
    law->bound_count = 0;
    law->s_n = scaled->s[n - 1];
    law->walk_cosine = cos(inputs.walk), law->walk_sine = sin(inputs.walk);
    law->toolface_cosine = cos(inputs.toolface), law->toolface_sine = sin(inputs.toolface);
    law->changes = law_changes(&inputs);
    law->longest = law->changes ? LONGEST_RAMP / growth_of(&inputs) : INFINITY;
    law->M = linear_of(&mode->M, places), law->F_0 = linear_of(&mode->F_0, places);
    law->touching = touching_of(modes, &regime.contact), law->finest = INFINITY;
    find_yields(&law->touching);
    for (int i = 0; i < law->count; i++) {
        if (i == n - 1) continue;
        law->q[i] = linear_of(&mode->delta[i], places);
        law->y_star[i] = modes->y_star[support_at(&regime.contact, n, i)];
        if (law->y_star[i] == 0.0) continue;
        law->finest = smaller(law->finest, law->y_star[i]);
        if (regime.contact.of[i]) add_bound(law, i, 0.0, INFINITY);
        else add_bound(law, i, -INFINITY, law->y_star[i]);
    }
    if (law->saturated) add_bound(law, n - 1, inputs.psi_star, INFINITY);
    else add_bound(law, n - 1, -INFINITY, inputs.psi_star);
    find_gains(law, mode_of(modes, &regime.contact), places);
}

/* How the frame turns along a step from the bit whose θ is a polynomial, as far as the law looks at it; 0 if too far. */
static inline int look_along(const Law *law, const Frame *start, const double theta[][S + 1], Turning *turning) {
    return make_turning(start, theta, (int)law->inputs.reference == FROM_NORTH, turning);
}

/* The bit tilt under F_0 and, where `by` is given, its derivative: |ψ| <= ψ*, and F_0 − ηΠ R₂(ϖ)ψ in the normal cone of that
   disc. */
static inline void tilt_under(
    const Law *law, double eta_pi, double psi_star, const double F_0[2], double psi[2], double by[2][2]
) {
    double cosine = law->walk_cosine, sine = law->walk_sine, factor = 1 / eta_pi, w, bend;
    if (!law->saturated) {
        psi[0] = factor * (cosine * F_0[0] + sine * F_0[1]), psi[1] = factor * (cosine * F_0[1] - sine * F_0[0]);
        if (by) by[0][0] = by[1][1] = factor * cosine, by[0][1] = factor * sine, by[1][0] = -factor * sine;
        return;
    }
    direction_factors(F_0[0] * F_0[0] + F_0[1] * F_0[1], eta_pi * psi_star, &w, &bend);
    double limit = eta_pi * psi_star * sine, s = limit * w;
    double c = s == 0.0 ? 1.0 : sqrt(larger(1 - s * s, 1e-4));
    for (int d = 0; d < 2; d++) psi[d] = psi_star * w * (c * F_0[d] + (d ? -s : s) * F_0[!d]);
    for (int d = 0; by && d < 2; d++) {
        double turn = d ? -1.0 : 1.0, by_s = (turn * F_0[!d] - s / c * F_0[d]) * w * limit;
        for (int k = 0; k < 2; k++) {
            double n_by = (d == k ? w : 0.0) + bend * F_0[d] * F_0[k],
                   m_by = (d != k ? w : 0.0) + bend * F_0[!d] * F_0[k];
            by[d][k] = psi_star * (c * n_by + turn * s * m_by + by_s * bend * F_0[k]);
        }
    }
}

/* What acts on the beam across the bit: the weight, the pads, and the string above, on the low side. */
typedef struct {
    Vector G, F_rss, high;
} Across;

/* Derivatives of the weight are among it only if `slopes` are asked for. */
static inline void look_across(
    const Law *law, const ScaledInputs *inputs, const double x[COMPONENTS], const View *view, const double first[2],
    int slopes, Across *across
) {
    double along = inputs->F_rss * law->toolface_cosine, aside = inputs->F_rss * law->toolface_sine, a[2];
    for (int d = 0; d < 2; d++) a[d] = x[LATERAL + d] - first[d] - x[ANGLE + d];
    weight_across(view->down, a, law->axial, slopes, &across->G);
    across->F_rss = inputs->F_rss != 0.0 ? pad_force(along, aside, (int)inputs->reference, view) : NO_VECTOR;
    across->high = law->modes->beam.end != 0.0 ? side_of(view->down, -1.0) : NO_VECTOR;
}

/* A row of the beam without contacts in one direction, less its terms of the hole behind. */
static inline double row_here(const Linear *row, const double x[COMPONENTS], int d, const Across *across) {
    return row->theta * x[ANGLE + d] + row->Y * x[LATERAL + d] + row->g * across->G.value[d] +
           row->rss * across->F_rss.value[d] + row->end * across->high.value[d];
}

/* Its derivatives by the state. */
static inline void row_slopes(const Linear *row, int d, const Across *across, double by[COMPONENTS]) {
    for (int c = 0; c < 2; c++) {
        by[ANGLE + c] = (d == c ? row->theta : 0.0) + row->g * across->G.by_theta[d][c] +
                        row->rss * across->F_rss.by_theta[d][c] + row->end * across->high.by_theta[d][c];
        by[LATERAL + c] = (d == c ? row->Y : 0.0) + row->g * across->G.by_Y[d][c];
    }
}

/* What the hole behind adds to each row, q_i, M and F_0, in either direction. */
typedef struct {
    double q[MAX_PLACES][2], M[2], F_0[2];
} Behind;

/* The rows of the beam without contacts: M, F_0 and each q. */
static inline void rows_here(
    const Law *law, const double x[COMPONENTS], const Across *across, const Behind *behind, Reply *at
) {
    for (int d = 0; d < 2; d++) {
        at->G[d] = across->G.value[d], at->F_rss[d] = across->F_rss.value[d];
        at->M[d] = row_here(&law->M, x, d, across) + behind->M[d];
        at->F_0[d] = row_here(&law->F_0, x, d, across) + behind->F_0[d];
        for (int i = 0; i < law->count; i++)
            if (i != law->n - 1) at->q[i][d] = row_here(&law->q[i], x, d, across) + behind->q[i][d];
    }
}

/* The law in the state `x`, `ahead` of where its inputs were taken over, with the frame in `view` and Y(ξ−s_1) as given, s_1 = 1.
   Contacts are sought from those in `at`; returns 0 if none are found. */
static inline int law_here(
    const Law *law, const double x[COMPONENTS], double ahead, const View *view, const Behind *behind,
    const double first[2], int slopes, Reply *at
) {
    ScaledInputs inputs = inputs_ahead(&law->inputs, ahead);
    Across across;
    look_across(law, &inputs, x, view, first, slopes, &across);
    int m = law->touching.touching;
    double eta_pi = at->eta_pi = inputs.eta_pi, by_F_0[2][2];
    at->psi_star = inputs.psi_star;
    double q_C[MAX_PLACES][2], F_by[MOST_TOUCHING][COMPONENTS], M_by[2][COMPONENTS], F_0_by[2][COMPONENTS];
    rows_here(law, x, &across, behind, at);
    for (int k = 0; k < m; k++) memcpy(q_C[k], at->q[law->touching.C[k]], sizeof q_C[k]);
    for (int k = 0; k < 2 * m && slopes; k++) /* those of q̃, and then of F */
        row_slopes(&law->q[law->touching.C[k / 2]], k % 2, &across, F_by[k]);
    if (m && !solve_contacts(&law->touching, q_C, at->v, at->F, slopes ? F_by : NULL)) return 0;
    for (int k = 0; k < m; k++)
        for (int d = 0; d < 2; d++) {
            at->M[d] += law->modes->beam.M_F[law->touching.support[k]] * at->F[k][d];
            at->F_0[d] += law->modes->beam.F0_F[law->touching.support[k]] * at->F[k][d];
        }
    tilt_under(law, eta_pi, inputs.psi_star, at->F_0, at->psi, slopes ? by_F_0 : NULL);
    double rate = 1 / inputs.chi_pi;
    for (int d = 0; d < 2; d++) {
        at->rate[ANGLE + d] = rate * at->M[d];
        at->rate[LATERAL + d] = x[ANGLE + d] - at->psi[d];
    }
    if (!slopes) return 1;
    for (int d = 0; d < 2; d++) row_slopes(&law->M, d, &across, M_by[d]), row_slopes(&law->F_0, d, &across, F_0_by[d]);
    for (int k = 0; k < m; k++)
        for (int d = 0; d < 2; d++)
            for (int c = 0; c < COMPONENTS; c++) {
                M_by[d][c] += law->modes->beam.M_F[law->touching.support[k]] * F_by[2 * k + d][c];
                F_0_by[d][c] += law->modes->beam.F0_F[law->touching.support[k]] * F_by[2 * k + d][c];
            }
    for (int d = 0; d < 2; d++)
        for (int c = 0; c < COMPONENTS; c++) {
            at->by[ANGLE + d][c] = rate * M_by[d][c];
            at->by[LATERAL + d][c] = (ANGLE + d == c) - by_F_0[d][0] * F_0_by[0][c] - by_F_0[d][1] * F_0_by[1][c];
        }
    return 1;
}

/* What the hole behind adds, from delayed lateral coordinates, `stride` numbers from direction to direction. */
static inline void look_behind(const Law *law, const double *delayed, int place, int direction, Behind *behind) {
    for (int d = 0; d < 2; d++) {
        behind->M[d] = behind->F_0[d] = 0.0;
        for (int i = 0; i < law->count; i++) behind->q[i][d] = 0.0;
        for (int j = 0; j < law->count; j++) {
            double Y_j = delayed[j * place + d * direction];
            behind->M[d] += law->M.delayed[j] * Y_j, behind->F_0[d] += law->F_0.delayed[j] * Y_j;
            for (int i = 0; i < law->count; i++)
                if (i != law->n - 1) behind->q[i][d] += law->q[i].delayed[j] * Y_j;
        }
    }
}

#endif
