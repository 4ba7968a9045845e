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

/* A beam in sections as it answers unit loads: its deflection at each node under a unit moment at the bit, under a unit
   shear there and under the weight, and what brings its end back to the hole. */
typedef struct {
    double bent[MAX_NODES], sheared[MAX_NODES], weighed[MAX_NODES];
    Answer to_force[MAX_NODES], to_offset, to_weight; /* to a force at each node, to e_n − δ_n, to the weight */
} Influence;

static inline double deflection_at(const Influence *of, Answer answer, int k) {
    return answer.m * of->bent[k] + answer.q * of->sheared[k];
}

/* Deflection at one node under a unit force at another. Below a force the line is the answer to it alone. */
static inline double flexibility_at(const Influence *of, int j, int k) {
    return j < k ? deflection_at(of, of->to_force[k], j) : deflection_at(of, of->to_force[j], k);
}

static inline void make_influence(Influence *of, const Nodes *nodes) {
    double bent[PARTS] = {0, 0, 1, 0}, sheared[PARTS] = {0, 0, 0, 1}, weighed[PARTS] = {0};
    double reach[2][PARTS] = {{1, 0, 0, 0}, {0, 0, 1, 0}}; /* from a line to deflection and moment at the end */
    int last = nodes->count - 1;
    for (int k = 0; k <= last; k++) {
        of->bent[k] = bent[DEFLECTION], of->sheared[k] = sheared[DEFLECTION], of->weighed[k] = weighed[DEFLECTION];
        if (k == last) break;
        pass_stretch(&nodes->above[k], 0.0, bent);
        pass_stretch(&nodes->above[k], 0.0, sheared);
        pass_stretch(&nodes->above[k], 1.0, weighed);
    }
    for (int k = last; k >= 0; k--) {
        if (k < last) look_down(&nodes->above[k], reach);
        of->to_force[k] = answer_to(bent, sheared, reach[0][SHEAR], reach[1][SHEAR]);
    }
    of->to_offset = answer_to(bent, sheared, 1.0, 0.0);
    of->to_weight = answer_to(bent, sheared, weighed[DEFLECTION], weighed[MOMENT]);
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
    double K_inv[MAX_STABILIZERS][MAX_STABILIZERS]; /* of a uniform beam, */
    Influence of;                                   /* of any other, with the node of each support */
    int stepped, node[MAX_SUPPORTS];
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

/* The deflection at support i under a unit force on support j. */
static inline double compliance(const Beam *beam, int i, int j) {
    return beam->stepped ? flexibility_at(&beam->of, beam->node[i], beam->node[j]) : beam->K_inv[i][j];
}

/* The beam in sections, under an axial load, with the points of its body. */
static inline void make_stepped_beam(Beam *beam, const Scaled *scaled, Axial axial) {
    Nodes nodes;
    Influence *of = &beam->of;
    make_nodes(&nodes, scaled, axial);
    make_influence(of, &nodes);
    int pads = node_at(&nodes, scaled->Delta);
    beam->n = scaled->n, beam->stepped = 1, beam->end = scaled->end_deflection;
    for (int i = 0; i < scaled->n + scaled->points; i++) {
        int k = beam->node[i] = node_at(&nodes, scaled->s[i]);
        beam->delta_e[i] = deflection_at(of, of->to_offset, k);
        beam->delta_rss[i] = flexibility_at(of, k, pads);
        beam->delta_g[i] = deflection_at(of, of->to_weight, k) + of->weighed[k];
        beam->M_F[i] = -of->to_force[k].m, beam->F0_F[i] = of->to_force[k].q;
    }
    beam->M_e = -of->to_offset.m, beam->F0_e = of->to_offset.q;
    beam->M_rss = -of->to_force[pads].m, beam->F0_rss = of->to_force[pads].q;
    beam->M_g = -of->to_weight.m, beam->F0_g = of->to_weight.q;
}

static inline void make_beam(Beam *beam, const Scaled *scaled, Axial axial) {
    if (scaled->stepped) make_stepped_beam(beam, scaled, axial);
    else make_uniform_beam(beam, scaled);
}

#endif
