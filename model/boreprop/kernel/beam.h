/* The BHA as an Euler–Bernoulli beam in the hole behind the bit: clamped to the bit, hinged at the last stabilizer.

   Everything here is dimensionless. What bends the beam are the offsets

       e_i = Σ_{k≤i} λ_k (⟨Θ⟩_k − θ) = Y(ξ) − Y(ξ−s_i) − s_i θ ,        i = 1 … n,

   of the bit's own axis from the hole axis at the stabilizers, the RSS force, the weight, and the contact forces. */
#ifndef BOREPROP_BEAM_H
#define BOREPROP_BEAM_H

#include "system.h"

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

/* M, F_0 and δ of one BHA as linear functions of e, F, F_RSS and sin⟨Θ⟩_1.

   With n stabilizers and i, j = 1 … n−1:

       δ_i = e_i + delta_e[i] e_n + Σ_j K_inv[i][j] F_j + delta_rss[i] F_RSS + delta_g[i] sin⟨Θ⟩_1      (5), (21)
       M   =       M_e e_n        + Σ_j M_F[j] F_j      + M_rss F_RSS        + M_g sin⟨Θ⟩_1             (17), (23)
       F_0 =       F0_e e_n       + Σ_j F0_F[j] F_j     + F0_rss F_RSS       + F0_g sin⟨Θ⟩_1            (14), (24)

   where M = −M_0 is the moment that turns the bit, εηΠ θ' = M. */
typedef struct {
    int n;
    double K_inv[MAX_STABILIZERS][MAX_STABILIZERS];
    double delta_e[MAX_STABILIZERS], delta_rss[MAX_STABILIZERS], delta_g[MAX_STABILIZERS];
    double M_e, M_F[MAX_STABILIZERS], M_rss, M_g;
    double F0_e, F0_F[MAX_STABILIZERS], F0_rss, F0_g;
} Beam;

static inline Beam make_beam(const Scaled *scaled) {
    const double *s = scaled->s, Delta = scaled->Delta, w = scaled->w;
    double lambda_ = s[scaled->n - 1];
    Beam beam = {0};
    beam.n = scaled->n;
    for (int i = 0; i < beam.n - 1; i++) {
        for (int j = 0; j < beam.n - 1; j++) beam.K_inv[i][j] = flexibility(s[i], s[j], lambda_);
        beam.delta_e[i] = end_offset_deflection(s[i], lambda_);
        beam.delta_rss[i] = flexibility(s[i], Delta, lambda_);
        beam.delta_g[i] = weight_deflection(s[i], w, lambda_);
        beam.M_F[i] = force_moment(s[i], lambda_);
        beam.F0_F[i] = force_reaction(s[i], lambda_);
    }
    beam.M_e = 1 / (lambda_ * lambda_);
    beam.M_rss = force_moment(Delta, lambda_);
    beam.M_g = w * lambda_ * lambda_ / 8;
    beam.F0_e = 1 / pow(lambda_, 3);
    beam.F0_rss = force_reaction(Delta, lambda_);
    beam.F0_g = 5.0 / 8 * w * lambda_;
    return beam;
}

#endif
