/* How a BHA lies in holes that are given, rather than drilled: for whatever is asked of one place at a time. */
#ifndef BOREPROP_LYING_H
#define BOREPROP_LYING_H

#include "drilling.h"

/* A BHA under an axial load. */
typedef struct {
    double l1, F_star;
    Scaled scaled;
    Modes modes;
} Lying;

/* How many supports the wall may push, with the last stabilizer among them, which it does not. */
static inline int support_count(const Lying *bha) { return bha->scaled.n + bha->scaled.points; }

/* A BHA that bears the weight on bit, N, and its own where the hole has the inclination, rad; 0, and the problem, if there
   is no such one. */
static inline int lay(Lying *bha, const System *system, double weight_on_bit, double inclination, Problem *problem) {
    if (!check_system(system, problem)) return 0;
    bha->l1 = length_scale(system), bha->F_star = force_scale(system), bha->scaled = scale(system);
    int loaded = bha->scaled.axial;
    double most = loaded ? buckling_weight(&bha->scaled, cos(inclination)) * bha->F_star : INFINITY;
    if (weight_on_bit >= most) return wrong(problem, BUCKLES, Q_WEIGHT_ON_BIT, 0, weight_on_bit, most);
    Axial axial = {loaded ? weight_on_bit / bha->F_star : 0.0, loaded ? cos(inclination) : 0.0};
    memcpy(bha->modes.y_star, bha->scaled.y_star, sizeof bha->modes.y_star);
    bha->modes.axial = axial;
    make_stepped_beam(&bha->modes.beam, &bha->scaled, axial);
    return 1;
}

/* How it lies where the bit's axis is off the hole by `loads`, m, at each support, then F_RSS, N, and g: contact forces,
   N, then F_0, N, and M, N·m, into `answers`; its distance from the bit's axis at increasing places `s`, m, into `shape`,
   m. Returns what is in the way of contacts, as `follow_load`. */
static inline Code lie(
    const Lying *bha, const double *loads, double *answers, Count count, const double *s, double *shape
) {
    const Beam *beam = &bha->modes.beam;
    double l1 = bha->l1;
    int supports = support_count(bha);
    Bending bending = {.F_rss = loads[supports] / bha->F_star, .g = loads[supports + 1]};
    Bent bent = {.F_rss = bending.F_rss, .g = bending.g, .end = beam->end};
    Path path;
    for (int i = 0; i < supports; i++) bent.e[i] = loads[i] / l1;
    Code problem = follow_load(&bha->modes, &bent, bha->scaled.points, &path);
    if (problem) return problem;
    bending.M = path.start.M + path.rate.M, bending.F_0 = path.start.F_0 + path.rate.F_0;
    for (int i = 0; i < supports; i++) {
        bending.F[i] = path.of[i] ? path.start.of[i] + path.rate.of[i] : 0.0;
        answers[i] = bending.F[i] * bha->F_star;
    }
    answers[supports] = bending.F_0 * bha->F_star, answers[supports + 1] = bending.M * bha->F_star * l1;
    beam_shape(beam, &bending, supports, l1, count, s, shape);
    return NO_PROBLEM;
}

#endif
