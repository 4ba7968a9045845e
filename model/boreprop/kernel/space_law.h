/* The law in space: the planar one in two directions across the bit's axis, which are those of its frame,

       εηΠ θ⃗' = M⃗ ,   Y⃗' = Θ⃗ = θ⃗ − ψ⃗

   with contacts and a bit tilt that are bounded by discs, the weight and the pads by the frame. Within a regime (which
   stabilizers touch, tilt saturated or not) the right-hand side is smooth, and a step of Radau collocation is solved by
   Newton's method. */
#ifndef BOREPROP_SPACE_LAW_H
#define BOREPROP_SPACE_LAW_H

#include "cone.h"
#include "step.h"

/* A row of the beam without contacts on the state, in either direction:
   theta θ + Y Y + Σ_i delayed[i] Y(ξ−s_i) + g G + rss F_RSS + end times the high side. */
typedef struct {
    double theta, Y, delayed[MAX_STABILIZERS], g, rss, end;
} Linear;

static inline Linear linear_of(const Row *row, const Places *places) {
    Linear linear = {.g = row->g, .rss = row->rss, .end = row->constant};
    for (int i = 0; i < places->count; i++) {
        linear.theta -= row->e[i] * places->s[i], linear.Y += row->e[i];
        linear.delayed[i] = -row->e[i];
    }
    return linear;
}

/* While a regime holds, a value lies between `lower` and `upper`: of the stabilizer `part`, |v| − y* in contact, where it
   is k times the force, else |δ|; of the tilt, |F_0|/(ηΠ). */
typedef struct {
    int part;
    double lower, upper;
} Bound;

#define LONGEST_RAMP 0.1 /* by which share ηΠ changes within a step, at most */

/* The right-hand side in one regime under given inputs, and the bounds within which it holds. */
typedef struct {
    int count, n, saturated, axial;
    const Beam *beam;
    double y_star[MAX_STABILIZERS], walk_cosine, walk_sine;
    ScaledInputs inputs;
    double inputs_xi; /* where the inputs are those that it was made under */
    double longest;   /* step under a changing ηΠ */
    Touching touching;
    Linear q[MAX_STABILIZERS], M, F_0; /* without contacts */
    double relaxation;
    int bound_count;
    Bound bounds[MAX_STABILIZERS];
    double gains[MAX_PLACES];
} Law;

/* How far the law's values change per change of Y(ξ−s_i), at most, and over which length θ forgets: those of a planar hole
   in which the same stabilizers touch. */
static inline void find_gains(Law *law, const Mode *mode, const Places *places) {
    double eta_pi = law->inputs.eta_pi, rate = 1 / (law->inputs.epsilon * eta_pi);
    Linear M = linear_of(&mode->M, places), F_0 = linear_of(&mode->F_0, places);
    law->relaxation = 1 / fabs(rate * M.theta - (law->saturated ? 0.0 : F_0.Y / eta_pi));
    for (int i = 0; i < law->count; i++) {
        law->gains[i] = fabs(M.delayed[i] / M.theta) + fabs(F_0.delayed[i]) / eta_pi;
        for (int k = 0; k < law->n - 1; k++) {
            Linear delta = linear_of(&mode->delta[k], places), F = linear_of(&mode->F[k], places);
            double k_i = compliance(law->beam, k, k);
            law->gains[i] = larger(law->gains[i], larger(fabs(delta.delayed[i]), k_i * fabs(F.delayed[i])));
        }
    }
    if (!law->axial) law->gains[0] += fabs(M.g / M.theta) + fabs(F_0.g) / eta_pi;
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
    Contact nothing = {{0}, 0, {0}};
    const Mode *mode = mode_of(modes, nothing);
    double growth = fabs(inputs.eta_pi_slope / inputs.eta_pi);
    int n = scaled->n;
    law->count = places->count, law->n = n, law->axial = scaled->axial, law->saturated = regime.saturation != 0;
    law->beam = &modes->beam, law->inputs = inputs, law->inputs_xi = inputs_xi, law->bound_count = 0;
    law->walk_cosine = cos(scaled->walk), law->walk_sine = sin(scaled->walk);
    law->longest = growth == 0 ? INFINITY : LONGEST_RAMP / growth;
    law->M = linear_of(&mode->M, places), law->F_0 = linear_of(&mode->F_0, places);
    law->touching = touching_of(modes, regime.contact);
    for (int i = 0; i < n - 1; i++) {
        law->q[i] = linear_of(&mode->delta[i], places), law->y_star[i] = modes->y_star[i];
        if (modes->y_star[i] == 0.0) continue;
        if (regime.contact.of[i]) add_bound(law, i, 0.0, INFINITY);
        else add_bound(law, i, -INFINITY, modes->y_star[i]);
    }
    if (law->saturated) add_bound(law, n - 1, inputs.psi_star, INFINITY);
    else add_bound(law, n - 1, -INFINITY, inputs.psi_star);
    find_gains(law, mode_of(modes, regime.contact), places);
}

/* A vector that depends on the frame, with its derivatives by θ and by Y while the hole behind stays. */
typedef struct {
    double value[2], by_theta[2][2], by_Y[2][2];
} Vector;

/* The weight: G = −((QP)₂·down, (QP)₃·down), P = R(⟨Θ⟩_1 − θ); where the axial load counts, P = 1. */
static inline Vector weight_across(const double down[3], const double a[2], int axial, double s_1) {
    double sine, cosine, square = a[0] * a[0] + a[1] * a[1], along = down[HIGH] * a[0] + down[RIGHT] * a[1];
    Vector G;
    if (axial) {
        for (int d = 0; d < 2; d++) {
            G.value[d] = -down[d];
            for (int c = 0; c < 2; c++) G.by_theta[d][c] = d == c ? down[AHEAD] : 0.0, G.by_Y[d][c] = 0.0;
        }
        return G;
    }
    turn_factors(square, &sine, &cosine);
    double sine_bend = square < 1e-6 ? -1.0 / 3 : ((1 - cosine * square) - sine) / square; /* (d/d|a|)/|a| */
    double cosine_bend = square < 1e-6 ? -1.0 / 12 : (sine - 2 * cosine) / square;
    for (int d = 0; d < 2; d++) {
        G.value[d] = -down[d] + a[d] * (cosine * along + sine * down[AHEAD]);
        for (int c = 0; c < 2; c++) {
            double same = d == c;
            double by_a = same * (cosine * along + sine * down[AHEAD]) +
                          a[d] * (cosine * down[c] + (cosine_bend * along + sine_bend * down[AHEAD]) * a[c]);
            double by_frame = same * down[AHEAD] + a[d] * (sine * down[c] - cosine * down[AHEAD] * a[c]);
            G.by_Y[d][c] = by_a / s_1;
            G.by_theta[d][c] = by_frame - by_a;
        }
    }
    return G;
}

/* Within this of the axis that they are measured from no side is up, and none is north: there forces that go by the side
   fade out. The sine of half a degree. */
#define NO_SIDE 0.008726535498373935

/* The side, across the bit, to which `seen` points, a vector of the rock as its row of the frame has it; `sign` times it. */
static inline Vector side_of(const double seen[3], double sign) {
    double square = seen[HIGH] * seen[HIGH] + seen[RIGHT] * seen[RIGHT], w, bend;
    Vector side;
    if (square >= NO_SIDE * NO_SIDE) w = 1 / sqrt(square), bend = -w / square;
    else {
        double t = square / (NO_SIDE * NO_SIDE);
        w = (15 + t * (-10 + 3 * t)) / (8 * NO_SIDE);
        bend = (-20 + 12 * t) / (8 * NO_SIDE * NO_SIDE * NO_SIDE);
    }
    for (int d = 0; d < 2; d++) {
        side.value[d] = sign * w * seen[d];
        for (int c = 0; c < 2; c++) {
            side.by_theta[d][c] = -sign * seen[AHEAD] * ((d == c ? w : 0.0) + bend * seen[d] * seen[c]);
            side.by_Y[d][c] = 0.0;
        }
    }
    return side;
}

/* Rows of the frame at a place: down and north. */
typedef struct {
    double down[3], north[3];
} View;

/* The force of the pads: at the toolface from the high side, from north or from e₂. */
static inline Vector pad_force(const ScaledInputs *inputs, const View *view) {
    double along = inputs->F_rss * cos(inputs->toolface), across = inputs->F_rss * sin(inputs->toolface);
    Vector side = {{1.0, 0.0}, {{0}}, {{0}}}, force;
    if (inputs->reference == FROM_HIGH_SIDE) side = side_of(view->down, -1.0);
    if (inputs->reference == FROM_NORTH) side = side_of(view->north, 1.0);
    for (int d = 0; d < 2; d++) {
        double turn = d ? 1.0 : -1.0;
        force.value[d] = along * side.value[d] + turn * across * side.value[!d];
        for (int c = 0; c < 2; c++) {
            force.by_theta[d][c] = along * side.by_theta[d][c] + turn * across * side.by_theta[!d][c];
            force.by_Y[d][c] = 0.0;
        }
    }
    return force;
}

/* The bit tilt under F_0, and its derivative: |ψ| <= ψ*, and F_0 − ηΠ R₂(ϖ)ψ in the normal cone of that disc. */
static inline void tilt_under(
    const Law *law, double eta_pi, double psi_star, const double F_0[2], double psi[2], double by[2][2]
) {
    double cosine = law->walk_cosine, sine = law->walk_sine, factor = 1 / eta_pi, w, bend;
    if (!law->saturated) {
        psi[0] = factor * (cosine * F_0[0] + sine * F_0[1]), psi[1] = factor * (cosine * F_0[1] - sine * F_0[0]);
        by[0][0] = by[1][1] = factor * cosine, by[0][1] = factor * sine, by[1][0] = -factor * sine;
        return;
    }
    direction_factors(F_0[0] * F_0[0] + F_0[1] * F_0[1], eta_pi * psi_star, &w, &bend);
    double limit = eta_pi * psi_star * sine, s = limit * w;
    double c = sqrt(larger(1 - s * s, 1e-4)), tangent = s / c;
    for (int d = 0; d < 2; d++) {
        double turn = d ? -1.0 : 1.0, n = w * F_0[d], m = w * F_0[!d];
        psi[d] = psi_star * (c * n + turn * s * m);
        for (int k = 0; k < 2; k++) {
            double n_by = (d == k ? w : 0.0) + bend * F_0[d] * F_0[k], m_by = (d != k ? w : 0.0) + bend * F_0[!d] * F_0[k];
            double s_by = limit * bend * F_0[k];
            by[d][k] = psi_star * (c * n_by + turn * s * m_by + (turn * m - tangent * n) * s_by);
        }
    }
}

/* A row of the beam without contacts in one direction, less its terms of the hole behind. */
static inline double row_here(
    const Linear *row, const double x[COMPONENTS], int d, const Vector *G, const Vector *F_rss, const Vector *high
) {
    return row->theta * x[ANGLE + d] + row->Y * x[LATERAL + d] + row->g * G->value[d] + row->rss * F_rss->value[d] +
           row->end * high->value[d];
}

/* Its derivatives by the state. */
static inline void row_slopes(
    const Linear *row, int d, const Vector *G, const Vector *F_rss, const Vector *high, double by[COMPONENTS]
) {
    for (int c = 0; c < 2; c++) {
        by[ANGLE + c] = (d == c ? row->theta : 0.0) + row->g * G->by_theta[d][c] + row->rss * F_rss->by_theta[d][c] +
                        row->end * high->by_theta[d][c];
        by[LATERAL + c] = (d == c ? row->Y : 0.0) + row->g * G->by_Y[d][c];
    }
}

/* What the hole behind adds to each row, q_i, M and F_0, in either direction. */
typedef struct {
    double q[MAX_STABILIZERS][2], M[2], F_0[2];
} Behind;

static inline double delayed_part(const Linear *row, int count, const double *delayed, int stride) {
    double sum = 0.0;
    for (int i = 0; i < count; i++) sum += row->delayed[i] * delayed[i * stride];
    return sum;
}

/* The law in the state `x`, `ahead` of where its inputs were taken over, with the frame in `view` and Y(ξ−s_1) as given.
   Contacts are sought from those in `at`; returns 0 if none are found. */
static inline int law_here(
    const Law *law, const double x[COMPONENTS], double ahead, const View *view, const Behind *behind,
    const double first[2], double s_1, int slopes, Reply *at
) {
    ScaledInputs inputs = inputs_ahead(law->inputs, ahead);
    int n = law->n, m = law->touching.touching;
    double a[2], eta_pi = inputs.eta_pi, by_F_0[2][2], answer[MOST_TOUCHING][MOST_TOUCHING];
    double q_C[MAX_STABILIZERS][2], q_by[MOST_TOUCHING][COMPONENTS], M_by[2][COMPONENTS], F_0_by[2][COMPONENTS];
    for (int d = 0; d < 2; d++) a[d] = (x[LATERAL + d] - first[d]) / s_1 - x[ANGLE + d];
    Vector G = weight_across(view->down, a, law->axial, s_1), F_rss = pad_force(&inputs, view);
    Vector high = {{0.0, 0.0}, {{0}}, {{0}}};
    if (law->beam->end != 0.0) high = side_of(view->down, -1.0);
    for (int d = 0; d < 2; d++) {
        at->G[d] = G.value[d], at->F_rss[d] = F_rss.value[d];
        at->M[d] = row_here(&law->M, x, d, &G, &F_rss, &high) + behind->M[d];
        at->F_0[d] = row_here(&law->F_0, x, d, &G, &F_rss, &high) + behind->F_0[d];
        for (int i = 0; i < n - 1; i++) at->q[i][d] = row_here(&law->q[i], x, d, &G, &F_rss, &high) + behind->q[i][d];
        for (int k = 0; k < m; k++) q_C[k][d] = at->q[law->touching.C[k]][d];
    }
    if (m && !solve_contacts(&law->touching, q_C, at->v, at->F, slopes ? answer : NULL)) return 0;
    for (int k = 0; k < m; k++)
        for (int d = 0; d < 2; d++) {
            at->M[d] += law->beam->M_F[law->touching.C[k]] * at->F[k][d];
            at->F_0[d] += law->beam->F0_F[law->touching.C[k]] * at->F[k][d];
        }
    tilt_under(law, eta_pi, inputs.psi_star, at->F_0, at->psi, by_F_0);
    double rate = 1 / (inputs.epsilon * eta_pi);
    for (int d = 0; d < 2; d++) {
        at->rate[ANGLE + d] = rate * at->M[d];
        at->rate[LATERAL + d] = x[ANGLE + d] - at->psi[d];
    }
    if (!slopes) return 1;
    for (int d = 0; d < 2; d++) {
        row_slopes(&law->M, d, &G, &F_rss, &high, M_by[d]), row_slopes(&law->F_0, d, &G, &F_rss, &high, F_0_by[d]);
        for (int k = 0; k < m; k++) row_slopes(&law->q[law->touching.C[k]], d, &G, &F_rss, &high, q_by[2 * k + d]);
    }
    for (int k = 0; k < m; k++)
        for (int d = 0; d < 2; d++)
            for (int c = 0; c < COMPONENTS; c++) {
                double F_by = 0.0;
                for (int j = 0; j < 2 * m; j++) F_by += answer[2 * k + d][j] * q_by[j][c];
                M_by[d][c] += law->beam->M_F[law->touching.C[k]] * F_by;
                F_0_by[d][c] += law->beam->F0_F[law->touching.C[k]] * F_by;
            }
    for (int d = 0; d < 2; d++)
        for (int c = 0; c < COMPONENTS; c++) {
            at->by[ANGLE + d][c] = rate * M_by[d][c];
            at->by[LATERAL + d][c] = (ANGLE + d == c) - by_F_0[d][0] * F_0_by[0][c] - by_F_0[d][1] * F_0_by[1][c];
        }
    return 1;
}

#endif
