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
    const Modes *modes;
    double s_1, s_n, y_star[MAX_STABILIZERS], walk_cosine, walk_sine;
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
            double k_i = compliance(&law->modes->beam, k, k);
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
    law->modes = modes, law->inputs = inputs, law->inputs_xi = inputs_xi, law->bound_count = 0;
    law->s_1 = scaled->s[0], law->s_n = scaled->s[n - 1];
    law->walk_cosine = cos(inputs.walk), law->walk_sine = sin(inputs.walk);
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
    double a[2], eta_pi = at->eta_pi = inputs.eta_pi, by_F_0[2][2], answer[MOST_TOUCHING][MOST_TOUCHING];
    double q_C[MAX_STABILIZERS][2], q_by[MOST_TOUCHING][COMPONENTS], M_by[2][COMPONENTS], F_0_by[2][COMPONENTS];
    for (int d = 0; d < 2; d++) a[d] = (x[LATERAL + d] - first[d]) / s_1 - x[ANGLE + d];
    Vector G = weight_across(view->down, a, law->axial, s_1), F_rss = pad_force(&inputs, view);
    Vector high = {{0.0, 0.0}, {{0}}, {{0}}};
    if (law->modes->beam.end != 0.0) high = side_of(view->down, -1.0);
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
            at->M[d] += law->modes->beam.M_F[law->touching.C[k]] * at->F[k][d];
            at->F_0[d] += law->modes->beam.F0_F[law->touching.C[k]] * at->F[k][d];
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
                M_by[d][c] += law->modes->beam.M_F[law->touching.C[k]] * F_by;
                F_0_by[d][c] += law->modes->beam.F0_F[law->touching.C[k]] * F_by;
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
        for (int i = 0; i < law->n - 1; i++) behind->q[i][d] = 0.0;
        for (int j = 0; j < law->count; j++) {
            double Y_j = delayed[j * place + d * direction];
            behind->M[d] += law->M.delayed[j] * Y_j, behind->F_0[d] += law->F_0.delayed[j] * Y_j;
            for (int i = 0; i < law->n - 1; i++) behind->q[i][d] += law->q[i].delayed[j] * Y_j;
        }
    }
}

/* The rows of the frame that the law looks at, along a step whose θ is a polynomial; returns 0 if it turns too far. */
typedef struct {
    int north;
    Series of_down, of_north;
} Views;

static inline int make_views(const Law *law, const Frame *frame, const double theta[][S + 1], Views *views) {
    views->north = law->inputs.reference == FROM_NORTH;
    return make_series(theta, frame->row[DOWN], &views->of_down) &&
           (!views->north || make_series(theta, frame->row[NORTH], &views->of_north));
}

static inline View view_at(const Views *views, double t) {
    View view = {{0}, {0}};
    series_at(&views->of_down, t, view.down);
    if (views->north) series_at(&views->of_north, t, view.north);
    return view;
}

enum { UNKNOWNS = S * COMPONENTS, MOST_ITERATIONS = 12 };
#define REST 0.03      /* what may be neglected of the solution of a step, in tolerances: little beside its error */
#define TOO_HARD 100.0 /* the error, over the tolerance, of a step that is not solved: the next is a third as long */
#define FARTHEST 2.0   /* over the last step, up to which its polynomial is taken as a guess */

/* One step of Newton's method on all stages. */
typedef struct {
    double row[UNKNOWNS][UNKNOWNS + 1];
} Correction;

/* Solve, in place; returns 0 if the matrix is singular. */
static inline int eliminate(Correction *correction) {
    double(*row)[UNKNOWNS + 1] = correction->row;
    for (int column = 0; column < UNKNOWNS; column++) {
        int pivot = column;
        for (int i = column + 1; i < UNKNOWNS; i++)
            if (fabs(row[i][column]) > fabs(row[pivot][column])) pivot = i;
        if (!(fabs(row[pivot][column]) > 0)) return 0;
        for (int j = column; pivot != column && j <= UNKNOWNS; j++) {
            double value = row[pivot][j];
            row[pivot][j] = row[column][j], row[column][j] = value;
        }
        for (int i = column + 1; i < UNKNOWNS; i++) {
            double factor = row[i][column] / row[column][column];
            if (factor == 0.0) continue;
            for (int j = column + 1; j <= UNKNOWNS; j++) row[i][j] -= factor * row[column][j];
        }
    }
    for (int i = UNKNOWNS - 1; i >= 0; i--) {
        for (int j = i + 1; j < UNKNOWNS; j++) row[i][UNKNOWNS] -= row[i][j] * row[j][UNKNOWNS];
        row[i][UNKNOWNS] /= row[i][i];
    }
    return 1;
}

/* What a step is solved with: the change of the state up to each node, and what its points need. */
typedef struct {
    double change[S][COMPONENTS], c[COMPONENTS][S + 1];
    Behind behind[POINTS];
    Views views;
} Solving;

static inline int point_of(int node) { return node < AT_CHECK ? node : node + 1; }

/* The polynomial of the step, and the state at its points. */
static inline void spread(const double x[COMPONENTS], Solving *solving, Trial *trial) {
    for (int c = 0; c < COMPONENTS; c++) {
        double *coefficient = solving->c[c];
        coefficient[0] = x[c];
        for (int m = 0; m < S; m++) {
            coefficient[m + 1] = 0.0;
            for (int j = 0; j < S; j++) coefficient[m + 1] += POLYNOMIAL[j][m] * solving->change[j][c];
        }
        for (int j = 0; j < S; j++) trial->x[c][point_of(j)] = x[c] + solving->change[j][c];
        trial->x[c][AT_CHECK] = polynomial(coefficient, POINT[AT_CHECK]);
    }
}

/* Let the law speak at a point of the step. */
static inline int speak(const Law *law, const Solving *solving, Trial *trial, int point, double s_1, int slopes) {
    double x[COMPONENTS], first[2] = {trial->delayed[0][0][point], trial->delayed[0][1][point]};
    View view = view_at(&solving->views, POINT[point]);
    for (int c = 0; c < COMPONENTS; c++) x[c] = trial->x[c][point];
    return law_here(law, x, trial->ahead[point], &view, &solving->behind[point], first, s_1, slopes, &trial->at[point]);
}

/* A guess: the last step goes on, or the state stays as it is. */
static inline void guess_changes(const Step *last, const double x[COMPONENTS], const Trial *trial, Solving *solving) {
    double from = (trial->step.xi - last->xi) / last->h, by = trial->step.h / last->h;
    int goes_on = last->end > last->xi && from + by <= 1 + FARTHEST;
    for (int j = 0; j < S; j++)
        for (int c = 0; c < COMPONENTS; c++)
            solving->change[j][c] =
                goes_on ? polynomial(last->x[c], from + by * POINT[point_of(j)]) - polynomial(last->x[c], from) : 0.0;
    (void)x;
}

/* One correction; gives its size. Returns 0 if there is none. */
static inline int correct(const Law *law, double s_1, double h, Solving *solving, Trial *trial, double *size) {
    Correction correction;
    for (int k = 0; k < S; k++) {
        int point = point_of(k);
        if (!speak(law, solving, trial, point, s_1, 1)) return 0;
        const Reply *at = &trial->at[point];
        for (int c = 0; c < COMPONENTS; c++) {
            double *row = correction.row[k * COMPONENTS + c], rest = h * at->rate[c];
            memset(row, 0, sizeof correction.row[0]);
            for (int j = 0; j < S; j++) {
                row[j * COMPONENTS + c] = DIFFERENCE[k][j];
                rest -= DIFFERENCE[k][j] * solving->change[j][c];
            }
            for (int e = 0; e < COMPONENTS; e++) row[k * COMPONENTS + e] -= h * at->by[c][e];
            row[UNKNOWNS] = rest;
        }
    }
    if (!eliminate(&correction)) return 0;
    *size = 0.0;
    for (int k = 0; k < S; k++)
        for (int c = 0; c < COMPONENTS; c++) {
            double by = correction.row[k * COMPONENTS + c][UNKNOWNS];
            solving->change[k][c] += by;
            if (!isfinite(by)) return 0;
            *size = larger(*size, fabs(by));
        }
    return 1;
}

/* Solve the step; returns 0 if no solution is found. */
static inline int solve_step(
    const Law *law, const Options *options, double s_1, const double x[COMPONENTS], Solving *solving, Trial *trial
) {
    double before = INFINITY, size = INFINITY;
    for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
        spread(x, solving, trial);
        if (!make_views(law, &trial->step.frame, (const double(*)[S + 1])solving->c, &solving->views)) return 0;
        before = size;
        if (!correct(law, s_1, trial->step.h, solving, trial, &size)) return 0;
        double rate = isfinite(before) ? size / before : 1.0;
        if (size == 0.0 || (rate < 1 && size * rate / (1 - rate) <= REST * options->relative_tolerance)) {
            spread(x, solving, trial);
            return make_views(law, &trial->step.frame, (const double(*)[S + 1])solving->c, &solving->views);
        }
    }
    return 0;
}

/* (1 − hJ/γ)⁻¹ times the defect, as in the plane; into the defect. */
static inline int damp(double h, const double J[COMPONENTS][COMPONENTS], double defect[COMPONENTS]) {
    double matrix[MOST_TOUCHING][2 * MOST_TOUCHING + 1];
    for (int c = 0; c < COMPONENTS; c++) {
        for (int e = 0; e < COMPONENTS; e++) matrix[c][e] = (c == e) - h / GAMMA[0].re * J[c][e];
        matrix[c][COMPONENTS] = defect[c];
    }
    if (!solve_touching(COMPONENTS, 1, matrix)) return 0;
    for (int c = 0; c < COMPONENTS; c++) defect[c] = matrix[c][COMPONENTS];
    return 1;
}

/* Contacts from which those along the step are sought: those that hold in the state at its start. */
static inline void guess_contacts(const Law *law, const double x[COMPONENTS], const Solving *solving, Trial *trial) {
    Contact nothing = {{0}, 0, {0}};
    Law without = *law;
    Reply at;
    View view;
    double v[MAX_STABILIZERS][2];
    if (law->touching.touching < 2) return;
    without.touching.touching = 0;
    memcpy(view.down, trial->step.frame.row[DOWN], sizeof view.down);
    memcpy(view.north, trial->step.frame.row[NORTH], sizeof view.north);
    const double first[2] = {trial->delayed[0][0][0], trial->delayed[0][1][0]};
    law_here(&without, x, trial->ahead[0], &view, &solving->behind[0], first, law->s_1, 0, &at);
    memcpy(v, at.q, sizeof v);
    settle_discs(law->modes, at.q, v, nothing);
    for (int point = 0; point < POINTS; point++)
        for (int k = 0; k < law->touching.touching; k++)
            memcpy(trial->at[point].v[k], v[law->touching.C[k]], sizeof v[0]);
}

/* Collocation from the state `x` over a trial step, whose place, length and delayed hole are given. */
static inline void law_try(
    const Law *law, const Options *options, const Step *last, const double x[COMPONENTS], Trial *trial
) {
    const double h = trial->step.h, s_1 = law->s_1;
    double defect[COMPONENTS];
    Solving solving;
    for (int k = 0; k < POINTS; k++) {
        trial->ahead[k] = trial->step.xi - law->inputs_xi + POINT[k] * h;
        look_behind(law, &trial->delayed[0][0][k], DIRECTIONS * POINTS, POINTS, &solving.behind[k]);
    }
    guess_changes(last, x, trial, &solving);
    guess_contacts(law, x, &solving, trial);
    int found = solve_step(law, options, s_1, x, &solving, trial);
    for (int k = 0; k < POINTS && found; k++) found = speak(law, &solving, trial, k, s_1, k == AT_CHECK);
    const Reply *check = &trial->at[AT_CHECK];
    for (int c = 0; c < COMPONENTS && found; c++)
        defect[c] = polynomial_slope(solving.c[c], POINT[AT_CHECK]) - h * check->rate[c];
    if (!found || !damp(h, check->by, defect)) {
        for (int c = 0; c < COMPONENTS; c++) memset(trial->step.x[c], 0, sizeof trial->step.x[c]);
        trial->error = TOO_HARD;
        return;
    }
    memcpy(trial->step.x, solving.c, sizeof trial->step.x);
    trial->error = 0.0;
    for (int c = 0; c < COMPONENTS; c++) {
        double weight = c < LATERAL ? options->theta_weight : 1.0;
        trial->error = larger(trial->error, weight * fabs(defect[c]) / options->relative_tolerance);
    }
}

/* How far a vector is. */
static inline double size_of(const double a[2]) { return hypot(a[0], a[1]); }

/* A bounded value, from what the law has said. */
static inline double bounded_value(const Law *law, const Bound *bound, const Reply *at) {
    int i = bound->part;
    if (i == law->n - 1) return size_of(at->F_0) / at->eta_pi;
    double delta[2] = {at->q[i][0], at->q[i][1]};
    for (int k = 0; k < law->touching.touching; k++) {
        if (law->touching.C[k] == i) return size_of(at->v[k]) - law->y_star[i];
        for (int d = 0; d < 2; d++) delta[d] += compliance(&law->modes->beam, i, law->touching.C[k]) * at->F[k][d];
    }
    return size_of(delta);
}

/* A bounded value at one place of a trial step. */
static inline double law_at(
    const Law *law, const Bound *bound, const Trial *trial, double xi, const double x[COMPONENTS],
    double delayed[][DIRECTIONS]
) {
    Behind behind;
    Views views;
    double t = (xi - trial->step.xi) / trial->step.h;
    int point = 0;
    while (point < POINTS - 1 && POINT[point] < t) point++;
    Reply at = trial->at[point];
    look_behind(law, &delayed[0][0], DIRECTIONS, 1, &behind);
    make_views(law, &trial->step.frame, trial->step.x, &views);
    View view = view_at(&views, t);
    if (!law_here(law, x, xi - law->inputs_xi, &view, &behind, delayed[0], law->s_1, 0, &at)) return (double)NAN;
    return bounded_value(law, bound, &at);
}

/* A bounded value at the points of a trial step. */
static inline void law_along(const Law *law, const Bound *bound, const Trial *trial, double values[POINTS]) {
    for (int k = 0; k < POINTS; k++) values[k] = bounded_value(law, bound, &trial->at[k]);
}

/* Go on to `xi` on the path north, east and down: ∫ T dξ, T = Q R(−ψ⃗)(0, 0, 1)ᵀ, by Gauss's three points. */
static inline void move_along(const Step *step, double xi, double path[AXES]) {
    double nodes[3] = {0.5 - sqrt(0.15), 0.5, 0.5 + sqrt(0.15)}, weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double length = xi - step->xi;
    if (length == 0.0) return;
    for (int axis = NORTH; axis <= DOWN; axis++) {
        Series series;
        make_series(step->x, step->frame.row[axis], &series);
        for (int k = 0; k < 3; k++) {
            double t = nodes[k] * length / step->h, row[3], turned[3], back[2];
            series_at(&series, t, row);
            for (int d = 0; d < 2; d++)
                back[d] = polynomial_slope(step->x[LATERAL + d], t) / step->h - polynomial(step->x[ANGLE + d], t);
            turned_row(row, back, turned);
            path[axis] += weights[k] * length * turned[AHEAD];
        }
    }
}

#define RIGHT_ANGLE 1.5707963267948966

/* Whether the bit, in the state `x` at the end of a trial step, has turned over: its axis is at more than a right angle to
   the hole between it and the last stabilizer. */
static inline int turns_over(const Law *law, const Trial *trial, const double x[COMPONENTS]) {
    double turn[2];
    for (int d = 0; d < 2; d++)
        turn[d] = (x[LATERAL + d] - trial->delayed[law->n - 1][d][POINTS - 1]) / law->s_n - x[ANGLE + d];
    return !(size_of(turn) <= RIGHT_ANGLE);
}

#endif
