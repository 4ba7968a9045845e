/* Contacts within discs from any start, by an interior-point method.

   The wall pushes support i with F_i = −λ_i δ_i and leaves it the room s_i:

       δ = q̃ + K⁻¹F ,   s_i = ½(y*_i² − |δ_i|²) > 0 ,   λ_i > 0 ,   λ_i s_i = μ

   For μ → 0 that is the contact problem. It is convex, and Newton's method leads there from anywhere if no step goes as far as
   to where a λ_i or s_i ends. Each is tried for μ = 0 first; how far that could go says for which μ it is taken, together with
   what the changes add in second order (Mehrotra 1992). A support without clearance is held, and F_i is not bound to δ_i. */
#ifndef BOREPROP_INTERIOR_H
#define BOREPROP_INTERIOR_H

#include "modes.h"

enum { MOST_TOUCHING = 2 * MAX_PLACES }; /* numbers: two for each support in contact */

/* The supports of a contact problem: the places of those that touch, C, and what belongs to them. */
typedef struct {
    int touching, C[MAX_PLACES], support[MAX_PLACES];
    double k[MAX_PLACES], y[MAX_PLACES];  /* by number in C; k as in cone.h */
    double K_inv[MAX_PLACES][MAX_PLACES]; /* of those in C */
} Touching;

static inline Touching touching_of(const Modes *modes, const Contact *contact) {
    Touching touching;
    int n = modes->beam.n, m = 0;
    for (int i = 0; i < place_count(*contact, n); i++)
        if (contact->of[i]) touching.C[m] = i, touching.support[m++] = support_at(contact, n, i);
    touching.touching = m;
    for (int a = 0; a < m; a++) {
        touching.y[a] = modes->y_star[touching.support[a]];
        for (int b = 0; b < m; b++)
            touching.K_inv[a][b] = compliance(&modes->beam, touching.support[a], touching.support[b]);
        touching.k[a] = touching.K_inv[a][a];
    }
    return touching;
}

/* A symmetric matrix, of which the upper half is there, or what is left of it when it has been eliminated. */
typedef struct {
    int size;
    double row[MOST_TOUCHING][MOST_TOUCHING];
} Symmetric;

/* Eliminate a positive matrix. By rounding it may be none where supports are close together. */
static inline void eliminate_symmetric(Symmetric *matrix) {
    double least[MOST_TOUCHING];
    for (int i = 0; i < matrix->size; i++) least[i] = 1e-16 * matrix->row[i][i];
    for (int column = 0; column < matrix->size; column++) {
        const double *top = matrix->row[column];
        matrix->row[column][column] = larger(top[column], least[column]);
        for (int i = column + 1; i < matrix->size; i++) {
            double factor = top[i] / top[column];
            for (int j = i; j < matrix->size; j++) matrix->row[i][j] -= factor * top[j];
        }
    }
}

static inline void solve_symmetric(const Symmetric *eliminated, double x[MOST_TOUCHING]) {
    int size = eliminated->size;
    for (int column = 0; column < size; column++) {
        const double *top = eliminated->row[column];
        double factor = x[column] / top[column];
        for (int j = column + 1; j < size; j++) x[j] -= factor * top[j];
    }
    for (int i = size - 1; i >= 0; i--)
        x[i] = (x[i] - dot(size - 1 - i, &eliminated->row[i][i + 1], &x[i + 1])) / eliminated->row[i][i];
}

#define LEAST_YIELD 1e-9 /* over K⁻¹_ii: rounding may take all where supports are close together */

/* Let k be what each support yields to a force while the others stay: one over the diagonal of (K⁻¹)⁻¹. */
static inline void find_yields(Touching *of) {
    int m = of->touching;
    Symmetric matrix = {.size = m};
    for (int a = 0; a < m; a++) memcpy(matrix.row[a], of->K_inv[a], (size_t)m * sizeof(double));
    eliminate_symmetric(&matrix);
    for (int a = 0; a < m; a++) {
        double x[MOST_TOUCHING] = {0}, own = of->K_inv[a][a];
        x[a] = 1.0;
        solve_symmetric(&matrix, x);
        of->k[a] = x[a] > 0 ? smaller(own, larger(1 / x[a], LEAST_YIELD * own)) : LEAST_YIELD * own;
    }
}

/* A support on its way to the solution. */
typedef struct {
    double delta[2], F[2], lambda, room;
} Inner;

/* What a step adds to it; and to λ s in second order. */
typedef struct {
    double delta[2], F[2], lambda, product;
} Change;

/* By how much δ changes under a change of the force where λ s stays: D⁻¹, D = λ(1 + δδᵀ/s). */
static inline void yield(const Inner *at, const double F[2], double by[2]) {
    double along = dot(2, at->delta, F) / (at->room + dot(2, at->delta, at->delta));
    for (int d = 0; d < 2; d++) by[d] = (F[d] - at->delta[d] * along) / at->lambda;
}

/* The matrix of a step for the changes of F, K⁻¹ + D⁻¹. */
static inline void make_matrix(const Touching *of, const Inner *at, Symmetric *matrix) {
    matrix->size = 2 * of->touching;
    for (int a = 0; a < of->touching; a++)
        for (int d = 0; d < 2; d++) {
            double unit[2] = {d == 0, d == 1}, own[2] = {0.0, 0.0};
            if (of->y[a] > 0) yield(&at[a], unit, own);
            for (int b = a; b < of->touching; b++)
                for (int c = 0; c < 2; c++)
                    matrix->row[2 * a + d][2 * b + c] = (c == d ? of->K_inv[a][b] : 0.0) + (a == b ? own[c] : 0.0);
        }
}

/* What is missing in the equations of δ; returns how far all is from the solution, relative. */
static inline double look_missing(
    const Touching *of, double q[MAX_PLACES][2], const Inner *at, double missing[MAX_PLACES][2]
) {
    double off = 0.0;
    for (int a = 0; a < of->touching; a++) {
        double y = of->y[a], pushes = of->K_inv[a][a] * at[a].lambda;
        for (int d = 0; d < 2; d++) {
            double terms = fabs(q[a][d]) + y;
            missing[a][d] = q[a][d] - at[a].delta[d];
            for (int b = 0; b < of->touching; b++) {
                double term = of->K_inv[a][b] * at[b].F[d];
                missing[a][d] += term, terms += fabs(term);
            }
            if (missing[a][d] != 0.0) off = larger(off, fabs(missing[a][d]) / terms);
        }
        if (y > 0) off = larger(off, pushes / (1 + pushes) * at[a].room / (y * y));
    }
    return off;
}

/* Find the step towards λ_i s_i = μ, with what the one in `by` adds in second order. */
static inline void step_towards(
    const Touching *of, const Symmetric *eliminated, const Inner *at, double missing[MAX_PLACES][2], double mu, Change *by
) {
    double x[MOST_TOUCHING], push[MAX_PLACES]; /* by which λ changes where δ stays */
    for (int a = 0; a < of->touching; a++) {
        double own[2] = {0.0, 0.0};
        push[a] = of->y[a] > 0 ? (mu - by[a].product) / at[a].room - at[a].lambda : 0.0;
        if (of->y[a] > 0) yield(&at[a], at[a].delta, own);
        for (int d = 0; d < 2; d++) x[2 * a + d] = -missing[a][d] - push[a] * own[d];
    }
    solve_symmetric(eliminated, x);
    for (int a = 0; a < of->touching; a++) {
        const double *delta = at[a].delta, lambda = at[a].lambda, room = at[a].room, square = dot(2, delta, delta);
        double rest[2], pulled = 0.0;
        int at_wall = of->K_inv[a][a] * lambda * square > room; /* so that differences keep their digits */
        for (int d = 0; d < 2; d++) {
            by[a].F[d] = x[2 * a + d];
            by[a].delta[d] = missing[a][d];
            for (int b = 0; b < of->touching; b++) by[a].delta[d] += of->K_inv[a][b] * x[2 * b + d];
            rest[d] = -push[a] * delta[d] - by[a].F[d];
        }
        if (!(of->y[a] > 0)) continue;
        if (at_wall) yield(&at[a], rest, by[a].delta);
        double along = dot(2, delta, by[a].delta);
        for (int d = 0; d < 2; d++) pulled += delta[d] * (by[a].F[d] + lambda * by[a].delta[d]);
        by[a].lambda = at_wall ? -pulled / square : push[a] + lambda * along / room;
        by[a].product = -by[a].lambda * along - lambda * dot(2, by[a].delta, by[a].delta) / 2;
    }
}

/* How far a step may go until the first λ or s ends. */
static inline double longest(const Touching *of, const Inner *at, const Change *by) {
    double share = INFINITY;
    for (int a = 0; a < of->touching; a++) {
        if (!(of->y[a] > 0)) continue;
        double square = dot(2, by[a].delta, by[a].delta), along = dot(2, at[a].delta, by[a].delta);
        double root = sqrt(along * along + 2 * square * at[a].room);
        if (by[a].lambda < 0) share = smaller(share, -at[a].lambda / by[a].lambda);
        if (square > 0) share = smaller(share, along > 0 ? 2 * at[a].room / (along + root) : (root - along) / square);
    }
    return share;
}

/* Go a share of a step. Room that rounding takes is left. */
static inline void move_inside(const Touching *of, const Change *by, double share, Inner *at) {
    for (int a = 0; a < of->touching; a++) {
        double square = of->y[a] * of->y[a];
        at[a].lambda += share * by[a].lambda;
        for (int d = 0; d < 2; d++) {
            at[a].delta[d] += share * by[a].delta[d];
            at[a].F[d] = square > 0 ? -at[a].lambda * at[a].delta[d] : at[a].F[d] + share * by[a].F[d];
        }
        at[a].room = larger((square - dot(2, at[a].delta, at[a].delta)) / 2, ROUNDING * square);
    }
}

/* The sum of λ s. */
static inline double sum_of_products(const Touching *of, const Inner *at) {
    double sum = 0.0;
    for (int a = 0; a < of->touching; a++)
        if (of->y[a] > 0) sum += at[a].lambda * at[a].room;
    return sum;
}

#define NEAR_ENOUGH 1e-11 /* relative: from there one step for μ = 0 leads to the solution but for rounding */
#define NOT_QUITE 0.99   /* of the way to where the first λ or s ends */
enum { MOST_APPROACHES = 60 }; /* ten as a rule, and under 25 */

/* v near the solution for supports that may touch, whatever q̃. */
APART static void approach(const Touching *of, double q[MAX_PLACES][2], double v[MAX_PLACES][2]) {
    int m = of->touching, near = 0;
    double missing[MAX_PLACES][2];
    Inner at[MAX_PLACES], tried[MAX_PLACES];
    Symmetric matrix;
    for (int a = 0; a < m; a++) {
        double y = of->y[a], pushes = larger(larger(fabs(q[a][0]), fabs(q[a][1])) / y, 1.0);
        Inner start = {{0.0, 0.0}, {0.0, 0.0}, pushes / of->K_inv[a][a], y * y / 2};
        at[a] = start;
    }
    for (int step = 0; step < MOST_APPROACHES && !near; step++) {
        Change by[MAX_PLACES] = {{{0}, {0}, 0, 0}};
        near = look_missing(of, q, at, missing) <= NEAR_ENOUGH;
        make_matrix(of, at, &matrix);
        eliminate_symmetric(&matrix);
        step_towards(of, &matrix, at, missing, 0.0, by);
        memcpy(tried, at, sizeof at);
        move_inside(of, by, near ? 1.0 : smaller(1.0, longest(of, at, by)), tried);
        if (!near) {
            double all = sum_of_products(of, at), left = all > 0 ? sum_of_products(of, tried) / all : 0.0;
            step_towards(of, &matrix, at, missing, left * left * left * all / m, by);
            move_inside(of, by, smaller(1.0, NOT_QUITE * longest(of, at, by)), at);
        }
    }
    for (int a = 0; a < m; a++)
        for (int d = 0; d < 2; d++) v[a][d] = tried[a].delta[d] - of->k[a] * tried[a].F[d];
}

#endif
