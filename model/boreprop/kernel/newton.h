/* Newton's method on all stages of a step of Radau collocation, for the law in space. */
#ifndef BOREPROP_NEWTON_H
#define BOREPROP_NEWTON_H

#include "disc_law.h"
#include "stages.h"

enum { MOST_ITERATIONS = 12 };
#define REST 1e-3 /* what may be left of the solution of a step, over what it may err, since it adds up over steps, … */
#define COARSEST 1e-7    /* … which counts no more than so, that a run of short steps is exact; … */
#define LEAST_REST 3e-14 /* … at least this, above the rounding of Y */
#define OF_CLEARANCE 0.1 /* the error of a step, over the least clearance, at most, … */
#define FINEST 1e-11     /* … or this, since clearances may be near rounding */
#define SLOW 0.1         /* a correction, over the last one, after which derivatives are taken anew */
#define OF_TILT 0.03     /* the error of the tilt in a step, over ψ*, at most, … */
#define NO_WAY 1e-12     /* … or what adds so little to Y that it is near rounding */
#define FARTHEST 2.0     /* over the last step, up to which its polynomial is taken as a guess */

/* What a step is solved with: the change of the state up to each node, and what its points need. */
typedef struct {
    double change[S][COMPONENTS], c[COMPONENTS][S + 1];
    Behind behind[POINTS];
    View view[POINTS];
} Solving;

static inline int point_of(int node) { return node < AT_CHECK ? node : node + 1; }

/* The polynomial of the step, and state and frame at its points; returns 0 if it turns too far. */
static inline int spread(const Law *law, const double x[COMPONENTS], Solving *solving, Trial *trial) {
    Turning turning;
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
    if (!look_along(law, &trial->step.frame, (const double (*)[S + 1]) solving->c, &turning)) return 0;
    view_at_points(&turning, solving->view);
    return 1;
}

/* Let the law speak at a point of the step. */
static inline int speak(const Law *law, const Solving *solving, Trial *trial, int point, int slopes) {
    double x[COMPONENTS], first[2] = {trial->delayed[0][0][point], trial->delayed[0][1][point]};
    for (int c = 0; c < COMPONENTS; c++) x[c] = trial->x[c][point];
    return law_here(
        law, x, trial->ahead[point], &solving->view[point], &solving->behind[point], first, slopes, &trial->at[point]
    );
}

/* A guess: the last step goes on or, where it is too short for that, turns on as it ends. */
static inline void guess_changes(const Step *last, const double x[COMPONENTS], const Trial *trial, Solving *solving) {
    double xi = trial->step.xi, h = trial->step.h, from = (xi - last->xi) / last->h, by = h / last->h;
    int moves = last->end > last->xi, goes_on = moves && from + by <= 1 + FARTHEST;
    for (int c = 0; c < COMPONENTS; c++) {
        double slope = moves ? h * step_derivative(last, c, 1, xi) : c < LATERAL ? 0.0 : h * x[c - LATERAL];
        double bend = moves ? h * h / 2 * step_derivative(last, c, 2, xi) : 0.0;
        double start = polynomial(last->x[c], from);
        for (int j = 0; j < S; j++) {
            double t = POINT[point_of(j)];
            solving->change[j][c] = goes_on ? polynomial(last->x[c], from + by * t) - start : t * (slope + t * bend);
        }
    }
}

/* The equations for the changes, from the derivatives by the state that the law has said at the nodes. */
static inline void gather(double h, const Trial *trial, Stages *stages) {
    for (int k = 0; k < S; k++)
        for (int j = 0; j < S; j++)
            for (int c = 0; c < COMPONENTS; c++)
                for (int e = 0; e < COMPONENTS; e++)
                    stages->block[k][j][c][e] =
                        (c == e ? DIFFERENCE[k][j] : 0.0) - (k == j ? h * trial->at[point_of(k)].by[c][e] : 0.0);
    eliminate(stages);
}

/* Let the law speak at the nodes; returns 0 if it cannot. */
static inline int speak_at_nodes(const Law *law, const Solving *solving, Trial *trial, int slopes) {
    int found = 1;
    for (int k = 0; k < S && found; k++) found = speak(law, solving, trial, point_of(k), slopes);
    return found;
}

/* The correction of the changes, by what the law has said; returns its size. */
static inline double find_correction(
    double h, const Stages *stages, const Solving *solving, const Trial *trial, double by[S][COMPONENTS]
) {
    double size = 0.0;
    for (int k = 0; k < S; k++)
        for (int c = 0; c < COMPONENTS; c++) {
            by[k][c] = h * trial->at[point_of(k)].rate[c];
            for (int j = 0; j < S; j++) by[k][c] -= DIFFERENCE[k][j] * solving->change[j][c];
        }
    solve_stages(stages, by);
    for (int k = 0; k < S; k++)
        for (int c = 0; c < COMPONENTS; c++)
            size = fabs(by[k][c]) <= size ? size : fabs(by[k][c]); /* or not a number */
    return size;
}

/* What a step may err in a part of the state: as asked for or, where that is smaller, a share of the least clearance. Steps
   that err more would not tell which stabilizers touch, and go on from contact to contact. A step in which θ `turns` by more
   than a clearance passes contacts anyway, and errs by a share of that. */
static inline double may_err(const Law *law, double asked, double turns) {
    return smaller(asked, larger(OF_CLEARANCE * larger(law->finest, turns), FINEST));
}

/* What it may err in Y by the tilt, in its residual and in what is left of its solution. The tilt turns with F_0, and fast
   where that is small: steps so short that no tilt makes an error in Y would not tell which regime follows. */
static inline double may_stray(const Law *law, double h) { return OF_TILT * h * law->inputs.psi_star + NO_WAY; }

/* Solve the step, with the derivatives as they are at first, and anew where that is slow; returns 0 if no solution is
   found. */
static inline int solve_step(
    const Law *law, const Options *options, const double x[COMPONENTS], Solving *solving, Trial *trial
) {
    Stages stages;
    double h = trial->step.h, least = smaller(may_err(law, options->relative_tolerance, 0.0), may_stray(law, h));
    double rest = larger(REST * smaller(least, COARSEST), LEAST_REST);
    double rate = INFINITY, before = INFINITY, by[S][COMPONENTS];
    for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
        int anew = rate > SLOW;
        if (!spread(law, x, solving, trial) || !speak_at_nodes(law, solving, trial, anew)) return 0;
        if (anew) gather(h, trial, &stages);
        double size = find_correction(h, &stages, solving, trial, by);
        if (iteration && size <= rest) return 1;
        if (!isfinite(size)) return 0;
        for (int k = 0; k < S; k++)
            for (int c = 0; c < COMPONENTS; c++) solving->change[k][c] += by[k][c];
        rate = size / before, before = size;
        if (iteration && rate < 1 && size * rate / (1 - rate) <= rest)
            return spread(law, x, solving, trial) && speak_at_nodes(law, solving, trial, 0);
    }
    return 0;
}

/* (1 − hJ/γ)⁻¹ times the defect, as in the plane; into the defect. */
static inline int damp(double h, const double J[COMPONENTS][COMPONENTS], double defect[COMPONENTS]) {
    Equations matrix;
    for (int c = 0; c < COMPONENTS; c++) {
        for (int e = 0; e < COMPONENTS; e++) matrix[c][e] = (c == e) - h / GAMMA[0].re * J[c][e];
        matrix[c][COMPONENTS] = defect[c];
    }
    if (!solve_equations(COMPONENTS, 1, matrix)) return 0;
    for (int c = 0; c < COMPONENTS; c++) defect[c] = matrix[c][COMPONENTS];
    return 1;
}

/* Contacts from which those along the step are sought: those that hold in the state at its start. */
static inline void guess_contacts(const Law *law, const double x[COMPONENTS], const Solving *solving, Trial *trial) {
    Reply at;
    View view;
    double v[MAX_PLACES][2];
    if (law->touching.touching < 2) return;
    memcpy(view.down, trial->step.frame.row[DOWN], sizeof view.down);
    memcpy(view.north, trial->step.frame.row[NORTH], sizeof view.north);
    const double first[2] = {trial->delayed[0][0][0], trial->delayed[0][1][0]};
    ScaledInputs inputs = inputs_ahead(&law->inputs, trial->ahead[0]);
    Across across;
    look_across(law, &inputs, x, &view, first, 0, &across);
    rows_here(law, x, &across, &solving->behind[0], &at);
    settle_discs(law->modes, at.q, v, law->contact);
    const Touching *of = &law->touching;
    for (int point = 0; point < POINTS; point++)
        for (int k = 0; k < of->touching; k++)
            restate(v[of->C[k]], of->y[k], of->K_inv[k][k], of->k[k], trial->at[point].v[k]);
}

/* Collocation from the state `x` over a trial step, whose place, length and delayed hole are given. */
static inline void law_try(
    const Law *law, const Options *options, const Step *last, const double x[COMPONENTS], Trial *trial
) {
    const double h = trial->step.h;
    double defect[COMPONENTS] = {0.0};
    Solving solving;
    for (int k = 0; k < POINTS; k++) {
        trial->ahead[k] = trial->step.xi - law->inputs_xi + POINT[k] * h;
        look_behind(law, &trial->delayed[0][0][k], DIRECTIONS * POINTS, POINTS, &solving.behind[k]);
    }
    guess_changes(last, x, trial, &solving);
    guess_contacts(law, x, &solving, trial);
    int found = solve_step(law, options, x, &solving, trial) && speak(law, &solving, trial, AT_CHECK, 1);
    const Reply *check = &trial->at[AT_CHECK];
    for (int c = 0; c < COMPONENTS && found; c++)
        defect[c] = polynomial_slope(solving.c[c], POINT[AT_CHECK]) - h * check->rate[c];
    trial->error = length_of(&defect[LATERAL]) / may_stray(law, h);
    if (!found || !damp(h, check->by, defect)) {
        for (int c = 0; c < COMPONENTS; c++) memset(trial->step.x[c], 0, sizeof trial->step.x[c]);
        trial->error = TOO_HARD;
        return;
    }
    memcpy(trial->step.x, solving.c, sizeof trial->step.x);
    double in_theta = options->relative_tolerance / weight_of_theta(options), in_Y = options->relative_tolerance;
    for (int c = 0; c < COMPONENTS; c++) {
        double turns = fabs(solving.change[S - 1][c]);
        double allowed = c < LATERAL ? may_err(law, in_theta, turns) : may_err(law, in_Y, 0.0);
        trial->error = larger(trial->error, fabs(defect[c]) / allowed);
    }
}

#endif
