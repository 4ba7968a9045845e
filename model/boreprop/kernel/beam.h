/* The BHA as an Euler–Bernoulli beam in the hole behind the bit: clamped to the bit, hinged at the last stabilizer.

   Everything here is dimensionless. What bends the beam are the offsets

       e_i = Σ_{k≤i} λ_k (⟨Θ⟩_k − θ) = Y(ξ) − Y(ξ−s_i) − s_i θ ,        i = 1 … n,

   of the bit's own axis from the hole axis at the stabilizers, the RSS force, the weight, and the contact forces. */
#ifndef BOREPROP_BEAM_H
#define BOREPROP_BEAM_H

#include "assembly.h"

/* Deflection at `s` under a unit force at `p`, eq. (20); symmetric in s and p. */
static inline double flexibility(double s, double p, double lambda_) {
    if (s < p) {
        double t = s;
        s = p, p = t;
    }
    double cube = pow(lambda_, 3);
    return p * p / (4 * cube) * (2 * cube * (3 * s - p) + (p - 3 * lambda_) * s * s * (3 * lambda_ - s));
}

/* Deflection at `s` under a unit offset e_n of the last stabilizer: ζ_k(s)/λ_k of eq. (21). */
static inline double end_offset_deflection(double s, double lambda_) {
    return s * s * (s - 3 * lambda_) / (2 * pow(lambda_, 3));
}

/* Deflection at `s` under the weight, per sin⟨Θ⟩_1: ζ_{n+2}(s) of eq. (21). */
static inline double weight_deflection(double s, double w, double lambda_) {
    return w / 16 * s * s * (2 * s - 3 * lambda_) * (lambda_ - s);
}

/* Moment M at the bit under a unit force at `p`: (23b) and (23c) times εηΠ. */
static inline double force_moment(double p, double lambda_) {
    return p * (p - lambda_) * (2 * lambda_ - p) / (2 * lambda_ * lambda_);
}

/* Lateral force F_0 at the bit under a unit force at `p`: (24b) and (24c). */
static inline double force_reaction(double p, double lambda_) {
    double cube = pow(lambda_, 3);
    return -(2 * cube - 3 * lambda_ * p * p + pow(p, 3)) / (2 * cube);
}

/* M, F_0 and δ of one BHA as linear functions of e, F, F_RSS and the sine g of an inclination.

   With n stabilizers and i, j = 1 … n−1:

       δ_i = e_i + delta_e[i] (e_n − δ_n) + Σ_j K_inv[i][j] F_j + delta_rss[i] F_RSS + delta_g[i] g      (5), (21)
       M   =       M_e (e_n − δ_n)        + Σ_j M_F[j] F_j      + M_rss F_RSS        + M_g g             (17), (23)
       F_0 =       F0_e (e_n − δ_n)       + Σ_j F0_F[j] F_j     + F0_rss F_RSS       + F0_g g            (14), (24)

   where M = −M_0 is the moment that turns the bit, εηΠ θ' = M. The paper has δ_n = 0 and g = sin⟨Θ⟩_1; where the axial
   load counts, the weight across the axis of the bit goes with g = sin θ. */
typedef struct {
    int n;
    double K_inv[MAX_STABILIZERS][MAX_STABILIZERS]; /* of a uniform beam */
    int stepped;
    Nodes nodes; /* of any other; the rest is by support, or of the pads */
    int node[MAX_SUPPORTS], pads;
    double bent[MAX_SUPPORTS], sheared[MAX_SUPPORTS]; /* deflections under a unit moment, a unit shear at the bit */
    double delta_e[MAX_SUPPORTS], delta_rss[MAX_SUPPORTS], delta_g[MAX_SUPPORTS];
    double M_e, M_F[MAX_SUPPORTS], M_rss, M_g;
    double F0_e, F0_F[MAX_SUPPORTS], F0_rss, F0_g;
    double end; /* δ_n */
} Beam;

static inline void make_uniform_beam(Beam *beam, const Scaled *scaled) {
    const double *s = scaled->s, Delta = scaled->Delta, w = scaled->w;
    double lambda_ = s[scaled->n - 1];
    beam->n = scaled->n, beam->stepped = 0, beam->end = 0.0;
    for (int i = 0; i < beam->n - 1; i++) {
        for (int j = 0; j < beam->n - 1; j++) beam->K_inv[i][j] = flexibility(s[i], s[j], lambda_);
        beam->delta_e[i] = end_offset_deflection(s[i], lambda_);
        beam->delta_rss[i] = flexibility(s[i], Delta, lambda_);
        beam->delta_g[i] = weight_deflection(s[i], w, lambda_);
        beam->M_F[i] = force_moment(s[i], lambda_);
        beam->F0_F[i] = force_reaction(s[i], lambda_);
    }
    beam->M_e = 1 / (lambda_ * lambda_);
    beam->M_rss = force_moment(Delta, lambda_);
    beam->M_g = w * lambda_ * lambda_ / 8;
    beam->F0_e = 1 / pow(lambda_, 3);
    beam->F0_rss = force_reaction(Delta, lambda_);
    beam->F0_g = 5.0 / 8 * w * lambda_;
}

/* The deflection at support i under a unit force on support j. Up to the force, the line of a beam in sections is what the
   bit answers to it. */
static inline double compliance(const Beam *beam, int i, int j) {
    if (!beam->stepped) return beam->K_inv[i][j];
    if (beam->node[i] > beam->node[j]) {
        int above = i;
        i = j, j = above;
    }
    return beam->F0_F[j] * beam->sheared[i] - beam->M_F[j] * beam->bent[i];
}

/* What the bit answers to a unit force at each node. */
static inline void answer_forces(
    const Nodes *nodes, const double bent[PARTS], const double sheared[PARTS], Answer *answers
) {
    double asked[2][PARTS] = {
        {1, 0, 0, 0}, {0, 0, 1, 0}
    }; /* deflection and moment at the end, from a line at the node */
    for (int k = nodes->count - 1; k >= 0; k--) {
        if (k < nodes->count - 1) look_down(&nodes->above[k], asked);
        answers[k] = answer_to(bent, sheared, asked[0][SHEAR], asked[1][SHEAR]);
    }
}

/* The beam in sections, under an axial load, with the points of its body. */
static inline void make_stepped_beam(Beam *beam, const Scaled *scaled, Axial axial) {
    Nodes *nodes = &beam->nodes;
    double bent[MAX_NODES][PARTS] = {{0, 0, 1, 0}}, sheared[MAX_NODES][PARTS] = {{0, 0, 0, 1}};
    double bowed[MAX_NODES][PARTS] = {{0}};
    Answer to_force[MAX_NODES] = {{0, 0}};
    make_nodes(nodes, scaled, axial);
    int last = nodes->count - 1, pads = beam->pads = node_at(nodes, scaled->Delta);
    for (int k = 0; k < last; k++) {
        memcpy(bent[k + 1], bent[k], sizeof bent[k]), memcpy(sheared[k + 1], sheared[k], sizeof sheared[k]);
        memcpy(bowed[k + 1], bowed[k], sizeof bowed[k]);
        pass_stretch(&nodes->above[k], 0.0, bent[k + 1]);
        pass_stretch(&nodes->above[k], 0.0, sheared[k + 1]);
        pass_stretch(&nodes->above[k], 1.0, bowed[k + 1]);
    }
    answer_forces(nodes, bent[last], sheared[last], to_force);
    Answer to_offset = answer_to(bent[last], sheared[last], 1.0, 0.0), to_pads = to_force[pads];
    Answer to_weight = answer_to(bent[last], sheared[last], bowed[last][DEFLECTION], bowed[last][MOMENT]);
    beam->n = scaled->n, beam->stepped = 1, beam->end = scaled->end_deflection;
    for (int i = 0; i < scaled->n + scaled->points; i++) {
        int k = beam->node[i] = node_at(nodes, scaled->s[i]), low = k < pads ? k : pads;
        Answer upper = k < pads ? to_pads : to_force[k];
        double v_m = beam->bent[i] = bent[k][DEFLECTION], v_q = beam->sheared[i] = sheared[k][DEFLECTION];
        beam->delta_e[i] = to_offset.m * v_m + to_offset.q * v_q;
        beam->delta_rss[i] = upper.m * bent[low][DEFLECTION] + upper.q * sheared[low][DEFLECTION];
        beam->delta_g[i] = to_weight.m * v_m + to_weight.q * v_q + bowed[k][DEFLECTION];
        beam->M_F[i] = -to_force[k].m, beam->F0_F[i] = to_force[k].q;
    }
    beam->M_e = -to_offset.m, beam->F0_e = to_offset.q;
    beam->M_rss = -to_pads.m, beam->F0_rss = to_pads.q;
    beam->M_g = -to_weight.m, beam->F0_g = to_weight.q;
}

/* What acts on a beam in sections: forces by support, F_RSS and g; and what it answers at the bit. */
typedef struct {
    double F[MAX_SUPPORTS], F_rss, g, M, F_0;
} Bending;

/* A walk along a beam in sections, from the bit up: the node below, and the line just above it. */
typedef struct {
    int node;
    double line[PARTS];
} Walk;

/* Add the forces at the node of a walk. */
static inline void add_forces(const Beam *beam, const Bending *bending, int supports, Walk *walk) {
    if (walk->node == beam->pads) walk->line[SHEAR] += bending->F_rss;
    for (int i = 0; i < supports; i++)
        if (beam->node[i] == walk->node) walk->line[SHEAR] += bending->F[i];
}

static inline Walk walk_from_bit(const Beam *beam, const Bending *bending, int supports) {
    Walk walk = {0, {0.0, 0.0, -bending->M, bending->F_0}};
    add_forces(beam, bending, supports, &walk);
    return walk;
}

/* Walk on to `s`, in ℓ₁, not back: gives the line there. */
static inline void walk_to(
    const Beam *beam, const Bending *bending, int supports, double s, Walk *walk, double line[PARTS]
) {
    const Nodes *nodes = &beam->nodes;
    while (walk->node < nodes->count - 2 && s > nodes->s[walk->node + 1]) {
        pass_stretch(&nodes->above[walk->node++], bending->g, walk->line);
        add_forces(beam, bending, supports, walk);
    }
    memcpy(line, walk->line, sizeof walk->line);
    carry_from(nodes, walk->node, s - nodes->s[walk->node], bending->g, line);
}

/* How far the beam is from the bit's axis at increasing places s, 0 <= s <= λ ℓ₁; lengths in the unit of ℓ₁. */
static inline void beam_shape(
    const Beam *beam, const Bending *bending, int supports, double l1, Count count, const double *s, double *v
) {
    Walk walk = walk_from_bit(beam, bending, supports);
    double line[PARTS];
    for (Count k = 0; k < count; k++) {
        walk_to(beam, bending, supports, s[k] / l1, &walk, line);
        v[k] = line[DEFLECTION] * l1;
    }
}

/* The line of a uniform beam at `s`, from the bit on: v'' = 3 m, m'' = −w g and the forces, m(0) = −M. */
static inline void uniform_line(const Scaled *scaled, const Bending *bending, double s, double line[PARTS]) {
    double load = scaled->w * bending->g, m = -bending->M, q = bending->F_0;
    double v = m * s * s / 2 + q * s * s * s / 6 - load * s * s * s * s / 24;
    double slope = m * s + q * s * s / 2 - load * s * s * s / 6, moment = m + q * s - load * s * s / 2;
    for (int i = -1; i < scaled->n + scaled->points; i++) { /* first the pads */
        double force = i < 0 ? bending->F_rss : bending->F[i];
        if (force == 0.0) continue;
        double above = larger(s - (i < 0 ? scaled->Delta : scaled->s[i]), 0.0);
        v += force * above * above * above / 6, slope += force * above * above / 2, moment += force * above;
        q += above > 0 ? force : 0.0;
    }
    line[DEFLECTION] = 3 * v, line[SLOPE_OF_BEAM] = 3 * slope, line[MOMENT] = moment, line[SHEAR] = q - load * s;
}

/* The line of any beam at `s`, 0 <= s <= λ. */
static inline void line_at(
    const Beam *beam, const Scaled *scaled, const Bending *bending, double s, double line[PARTS]
) {
    if (scaled->uniform) {
        uniform_line(scaled, bending, s, line);
        return;
    }
    Walk walk = walk_from_bit(beam, bending, scaled->n + scaled->points);
    walk_to(beam, bending, scaled->n + scaled->points, s, &walk, line);
}

static inline void make_beam(Beam *beam, const Scaled *scaled, Axial axial) {
    if (scaled->stepped) make_stepped_beam(beam, scaled, axial);
    else make_uniform_beam(beam, scaled);
}

#endif
