/* Newton's method on all stages of a step of Radau collocation, for the law in space. */
#ifndef BOREPROP_NEWTON_H
#define BOREPROP_NEWTON_H

#include "disc_law.h"

/* The rows of the frame that the law looks at, along a step whose θ is a polynomial; returns 0 if it turns too far. */
typedef struct {
    int north;
    Series of_down, of_north;
} Views;

static inline int make_views(const Law *law, const Frame *frame, const double theta[][S + 1], Views *views) {
    views->north = (int)law->inputs.reference == FROM_NORTH;
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
#define REST 0.03      /* what may be left of the solution of a step, over what it may err: little beside its error */
#define FINEST 1e-11   /* the least error in Y that is asked for: clearances in contact may be near rounding */
#define TOO_HARD 100.0 /* the error, over the tolerance, of a step that is not solved: the next is a third as long */
#define AIMED 0.03     /* of ψ*: the error of a saturated tilt in a step, at most, … */
#define NO_WAY 1e-12   /* … or what adds so little to Y that it is near rounding */
#define FARTHEST 2.0   /* over the last step, up to which its polynomial is taken as a guess */

/* One step of Newton's method on all stages. */
typedef struct {
    double row[UNKNOWNS][UNKNOWNS + 1];
} Correction;

/* Solve, in place; returns 0 if the matrix is singular. */
static inline int eliminate(Correction *correction) {
    double (*row)[UNKNOWNS + 1] = correction->row;
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

/* A guess: the last step goes on or, where it is too short for that, the hole goes straight on. */
static inline void guess_changes(const Step *last, const double x[COMPONENTS], const Trial *trial, Solving *solving) {
    double from = (trial->step.xi - last->xi) / last->h, by = trial->step.h / last->h;
    int goes_on = last->end > last->xi && from + by <= 1 + FARTHEST;
    for (int c = 0; c < COMPONENTS; c++) {
        double slope = c < LATERAL            ? 0.0
                       : last->end > last->xi ? polynomial_slope(last->x[c], from) * by
                                              : x[c - LATERAL] * trial->step.h;
        double start = polynomial(last->x[c], from);
        for (int j = 0; j < S; j++) {
            double t = POINT[point_of(j)];
            solving->change[j][c] = goes_on ? polynomial(last->x[c], from + by * t) - start : slope * t;
        }
    }
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

/* What a step may err in Y: a tolerance or, where that is smaller, the least clearance in contact. Steps that err more would
   not tell whether a stabilizer stays on the wall. */
static inline double may_err(const Law *law, const Options *options) {
    return smaller(options->relative_tolerance, larger(law->finest, FINEST));
}

/* What it may err in Y by a saturated tilt, in its residual and in what is left of its solution. The tilt turns with F_0, and
   fast where that is small: steps so short that no tilt makes an error in Y would not tell which regime follows. */
static inline double may_stray(const Law *law, double h) {
    return law->saturated ? AIMED * h * law->inputs.psi_star + NO_WAY : INFINITY;
}

/* Solve the step; returns 0 if no solution is found. */
static inline int solve_step(
    const Law *law, const Options *options, double s_1, const double x[COMPONENTS], Solving *solving, Trial *trial
) {
    double before = INFINITY, size = INFINITY;
    double rest = REST * smaller(may_err(law, options), may_stray(law, trial->step.h));
    for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
        spread(x, solving, trial);
        if (!make_views(law, &trial->step.frame, (const double (*)[S + 1]) solving->c, &solving->views)) return 0;
        before = size;
        if (!correct(law, s_1, trial->step.h, solving, trial, &size)) return 0;
        double rate = isfinite(before) ? size / before : 1.0;
        if (size == 0.0 || (rate < 1 && size * rate / (1 - rate) <= rest)) {
            spread(x, solving, trial);
            return make_views(law, &trial->step.frame, (const double (*)[S + 1]) solving->c, &solving->views);
        }
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
    Across across = across_the_bit(law, &inputs, x, &view, first, law->s_1);
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
    const double h = trial->step.h, s_1 = law->s_1;
    double defect[COMPONENTS] = {0.0};
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
    trial->error = hypot(defect[LATERAL], defect[LATERAL + 1]) / may_stray(law, h);
    if (!found || !damp(h, check->by, defect)) {
        for (int c = 0; c < COMPONENTS; c++) memset(trial->step.x[c], 0, sizeof trial->step.x[c]);
        trial->error = TOO_HARD;
        return;
    }
    memcpy(trial->step.x, solving.c, sizeof trial->step.x);
    for (int c = 0; c < COMPONENTS; c++) {
        double allowed = c < LATERAL ? options->relative_tolerance / options->theta_weight : may_err(law, options);
        trial->error = larger(trial->error, fabs(defect[c]) / allowed);
    }
}

#endif
