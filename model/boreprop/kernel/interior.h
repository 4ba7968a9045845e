/* Contacts within discs from any start, by an interior-point method.

   The wall pushes support i with F_i = −λ_i δ_i and leaves it the room s_i:

       δ = q̃ + K⁻¹F ,   s_i = ½(y*_i² − |δ_i|²) > 0 ,   λ_i > 0 ,   λ_i s_i = μ w_i

   For μ → 0 that is the contact problem, whatever the weights w_i. It is convex, and Newton's method leads there if no step goes
   as far as to where a λ_i or s_i ends. Each is tried for μ = 0 first; how far that could go says for which μ it is taken, with
   what the changes add in second order (Mehrotra 1992). A support without clearance is held, and F_i is not bound to δ_i. */
#ifndef BOREPROP_INTERIOR_H
#define BOREPROP_INTERIOR_H

#include "touching.h"

/* A support on its way to the solution. */
typedef struct {
    double delta[2], F[2], lambda, room, weight;
} Inner;

/* What a step adds to it: `along` is δ·dδ, by which the room shrinks, and `product` what λ s gains in second order. */
typedef struct {
    double delta[2], F[2], lambda, along, product;
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

/* Find the step towards λ_i s_i = μ w_i, with what the one in `by` adds in second order. */
static inline void step_towards(
    const Touching *of, const Symmetric *eliminated, const Inner *at, double missing[MAX_PLACES][2], double mu,
    Change *by
) {
    double x[MOST_TOUCHING], push[MAX_PLACES]; /* by which λ changes where δ stays */
    for (int a = 0; a < of->touching; a++) {
        double own[2] = {0.0, 0.0};
        push[a] = of->y[a] > 0 ? (mu * at[a].weight - by[a].product) / at[a].room - at[a].lambda : 0.0;
        if (of->y[a] > 0) yield(&at[a], at[a].delta, own);
        for (int d = 0; d < 2; d++) x[2 * a + d] = -missing[a][d] - push[a] * own[d];
    }
    solve_symmetric(eliminated, x);
    for (int a = 0; a < of->touching; a++) {
        const double *delta = at[a].delta, lambda = at[a].lambda, room = at[a].room, square = dot(2, delta, delta);
        double rest[2];
        int at_wall = of->K_inv[a][a] * lambda * square > room; /* so that differences keep their digits */
        for (int d = 0; d < 2; d++) {
            by[a].F[d] = x[2 * a + d];
            by[a].delta[d] = missing[a][d];
            for (int b = 0; b < of->touching; b++) by[a].delta[d] += of->K_inv[a][b] * x[2 * b + d];
            rest[d] = -push[a] * delta[d] - by[a].F[d];
        }
        if (!(of->y[a] > 0)) continue;
        double along = dot(2, delta, by[a].delta), pulled = dot(2, delta, by[a].F);
        if (at_wall) {
            yield(&at[a], rest, by[a].delta);
            along = dot(2, delta, rest) / lambda * (room / (room + square));
        }
        by[a].along = along;
        by[a].lambda = at_wall ? -(pulled + lambda * along) / square : push[a] + lambda * along / room;
        by[a].product = -by[a].lambda * along - lambda * dot(2, by[a].delta, by[a].delta) / 2;
    }
}

/* How far a step may go until the first λ or s ends. */
static inline double longest(const Touching *of, const Inner *at, const Change *by) {
    double share = INFINITY;
    for (int a = 0; a < of->touching; a++) {
        if (!(of->y[a] > 0)) continue;
        double square = dot(2, by[a].delta, by[a].delta), along = by[a].along;
        double root = sqrt(along * along + 2 * square * at[a].room);
        if (by[a].lambda < 0) share = smaller(share, -at[a].lambda / by[a].lambda);
        if (square > 0) share = smaller(share, along > 0 ? 2 * at[a].room / (along + root) : (root - along) / square);
    }
    return share;
}

/* Go a share of a step. */
static inline void move_inside(const Touching *of, const Change *by, double share, Inner *at) {
    for (int a = 0; a < of->touching; a++) {
        at[a].lambda += share * by[a].lambda;
        at[a].room -= share * (by[a].along + share * dot(2, by[a].delta, by[a].delta) / 2);
        for (int d = 0; d < 2; d++) {
            at[a].delta[d] += share * by[a].delta[d];
            at[a].F[d] = of->y[a] > 0 ? -at[a].lambda * at[a].delta[d] : at[a].F[d] + share * by[a].F[d];
        }
    }
}

/* The μ of all supports together. */
static inline double mean_mu(const Touching *of, const Inner *at) {
    double sum = 0.0, weights = 0.0;
    for (int a = 0; a < of->touching; a++)
        if (of->y[a] > 0) sum += at[a].lambda * at[a].room, weights += at[a].weight;
    return weights > 0 ? sum / weights : 0.0;
}

#define NEAR_ENOUGH 1e-11 /* relative: from there one step for μ = 0 leads to the solution but for rounding */
#define LEFT_OUT 0.1      /* of the way to where the first λ or s ends: so much far from the solution, … */
#define LEFT_LEAST 1e-3   /* … and so much near it */
enum { MOST_STEPS = 40 }; /* from one start: thirteen as a rule */

/* Go from δ = 0 and λ_i s_i = μ w_i to the solution; returns 0 if that takes too many steps. */
static inline int approach_from(const Touching *of, double q[MAX_PLACES][2], double mu, Inner at[MAX_PLACES]) {
    double missing[MAX_PLACES][2];
    Symmetric matrix;
    for (int a = 0; a < of->touching; a++) {
        double y = of->y[a], way = larger(larger(fabs(q[a][0]), fabs(q[a][1])), y), weight = y * way / of->K_inv[a][a];
        Inner start = {{0.0, 0.0}, {0.0, 0.0}, y > 0 ? 2 * mu * weight / (y * y) : 0.0, y * y / 2, weight};
        at[a] = start;
    }
    for (int step = 0; step < MOST_STEPS; step++) {
        Inner tried[MAX_PLACES];
        Change by[MAX_PLACES] = {{{0}, {0}, 0, 0, 0}};
        double off = look_missing(of, q, at, missing);
        make_matrix(of, at, &matrix);
        eliminate_symmetric(&matrix);
        step_towards(of, &matrix, at, missing, 0.0, by);
        if (off <= NEAR_ENOUGH) {
            move_inside(of, by, 1.0, at);
            return 1;
        }
        memcpy(tried, at, sizeof tried);
        move_inside(of, by, smaller(1.0, longest(of, at, by)), tried);
        double now = mean_mu(of, at), left = now > 0 ? mean_mu(of, tried) / now : 0.0;
        step_towards(of, &matrix, at, missing, left * left * left * now, by);
        double share = 1 - larger(LEFT_LEAST, smaller(LEFT_OUT, off));
        move_inside(of, by, smaller(1.0, share * longest(of, at, by)), at);
    }
    return 0;
}

#define FIRST_MU 10.0 /* of the first start; … */
#define MORE_MU 1e3   /* … by so much more it is of the next, where one leads nowhere */
enum { MOST_STARTS = 4 };

/* v near the solution for supports that may touch, whatever q̃. */
APART static void approach(const Touching *of, double q[MAX_PLACES][2], double v[MAX_PLACES][2]) {
    Inner at[MAX_PLACES];
    double mu = FIRST_MU;
    for (int start = 0; start < MOST_STARTS && !approach_from(of, q, mu, at); start++) mu *= MORE_MU;
    for (int a = 0; a < of->touching; a++)
        for (int d = 0; d < 2; d++) v[a][d] = at[a].delta[d] - of->k[a] * at[a].F[d];
}

#endif
