/* The kinks of the hole, where a derivative of its lateral coordinate jumps. The stabilizers will pass them, and no step
   may pass over a kink that matters. */
#ifndef BOREPROP_KINKS_H
#define BOREPROP_KINKS_H

#include "step.h"

#define MERGE 1e-9 /* ℓ₁: kinks closer than this are one; far above the rounding of their sums ξ + s_i */
/* The highest derivative of Y whose jumps are followed: what a jump in a higher one does is small, and the error
   estimate sees it. */
#define SMOOTHEST_KINK 3
enum { SMOOTH = 100 }; /* the order where there is no kink: higher than that of any */

/* A jump in derivative `order` of the lateral coordinate at `xi`. */
typedef struct {
    double xi, jump, order;
} Kink;

/* The kinks that are kept, up to the one before `end`; number k lies at k modulo the capacity of the ring, a power of
   two. They count as many in space, and once the law has changed on the way. The support at place i will next pass
   number ahead[i]. */
typedef struct {
    Kink *ring;
    Count capacity, end;
    int many;
    Count ahead[MAX_PLACES];
} Kinks;

static inline Kink *kink(const Kinks *kinks, Count k) { return &kinks->ring[k & (kinks->capacity - 1)]; }

/* Number of the oldest kink that is kept: the one that the last stabilizer will pass next. */
static inline Count first_kink(const Kinks *kinks, int n) { return kinks->ahead[n - 1]; }

/* Number of the first kink beyond `xi`, from number `low` on. */
static inline Count kink_beyond(const Kinks *kinks, Count low, double xi) {
    for (Count high = kinks->end; low < high;) {
        Count middle = low + (high - low) / 2;
        if (kink(kinks, middle)->xi > xi) high = middle;
        else low = middle + 1;
    }
    return low;
}

/* Mark a jump, which the stabilizers will pass; jumps at one place in one derivative add up. */
static inline void add_kink(Kinks *kinks, int n, double xi, int order, double jump) {
    Kink added = {xi, jump, order}, *last = kink(kinks, kinks->end - 1);
    if (order > SMOOTHEST_KINK) return;
    if (kinks->end > first_kink(kinks, n) && last->xi == xi && last->order == order) last->jump += jump;
    else *kink(kinks, kinks->end++) = added;
}

/* Take the kinks up to `xi` off the lists; returns the lowest derivative of the hole that jumps at `xi` by those within
   `near` of it. */
static inline int kink_here(Kinks *kinks, const Places *places, double xi, double near) {
    int lowest = SMOOTH;
    for (int i = 0; i < places->count; i++)
        for (Count *k = &kinks->ahead[i]; *k < kinks->end; ++*k) {
            const Kink *next = kink(kinks, *k);
            double at = next->xi + places->s[i];
            if (at - xi > near) break;
            if (xi - at <= near && next->order + 1 < lowest) lowest = (int)next->order + 1;
        }
    return lowest;
}

/* How far θ, or a bounded value, and Θ change per change of Y at a place. */
typedef struct {
    double theta, Theta;
} Gain;

/* What a step of length h over a jump of 1 in derivative m of the delayed Y errs: in Y up to PASSED_Y[m] h^(m+1) by a gain
   of Θ of 1, in θ up to PASSED_THETA[m] h^m by a gain of θ of 1. Largest errors of the interpolation of (t − a)^m/m!, which
   begins at any a in [0, 1], between the Radau nodes, and of the integral of that. */
static const double PASSED_Y[SMOOTHEST_KINK + 1] = {0, 9.13e-3, 4.40e-4, 3.51e-5};
static const double PASSED_THETA[SMOOTHEST_KINK + 1] = {0, 7.17e-2, 6.09e-3, 7.31e-4};

/* What passing a kink does to a step, per jump and gain, by the order of the kink: to θ, and by Θ. */
typedef struct {
    double theta[SMOOTHEST_KINK + 1], Theta[SMOOTHEST_KINK + 1];
} Harm;

/* Of a step of length `h`, where errors of θ have this weight. It is no more than what a kink changes over twice the step,
   which counts where there are not many: in a plane, before the law changes on the way, while no point of the body is
   watched. Such runs keep their steps to the last bit. */
static inline void find_harm(double h, double theta_weight, int many, Harm *harm) {
    static const double factorial[] = {1, 1, 2, 6, 24};
    double power = h, twice = 2 * h;
    for (int m = 1; m <= SMOOTHEST_KINK; m++) {
        twice *= 2 * h;
        double most = twice / factorial[m + 1];
        harm->theta[m] = many ? smaller(most, power * (theta_weight * PASSED_THETA[m])) : most;
        harm->Theta[m] = many ? smaller(most, power * (PASSED_Y[m] * h)) : most;
        power *= h;
    }
}

/* Where the next kink within `h` of `xi` lies that a step must not pass; infinity if there is none. It may pass
   those that do it less harm than the tolerance; `gains` are those of the law. */
static inline double next_kink(
    const Kinks *kinks, const Places *places, const Gain *gains, const Harm *harm, double tolerance, double xi, double h
) {
    double first = INFINITY;
    for (int i = 0; i < places->count; i++)
        for (Count k = kinks->ahead[i]; k < kinks->end; k++) {
            const Kink *next = kink(kinks, k);
            double at = next->xi + places->s[i];
            if (at >= xi + h || at >= first) break;
            int m = (int)next->order;
            double of_theta = gains[i].theta * next->jump * harm->theta[m];
            if (larger(of_theta, gains[i].Theta * next->jump * harm->Theta[m]) > tolerance) first = at;
        }
    return first;
}

/* How far the next kink is that a step from `xi` must not pass, of the length `h` at most, which it gives. Where there are
   `many` kinks, the length is halved until the step goes farther than to half of it: a shorter step may pass a kink that a
   longer one may not. */
static inline double reach(
    const Kinks *kinks, const Places *places, const Gain *gains, const Options *options, int many, double xi, double *h
) {
    Harm harm;
    for (;; *h /= 2) {
        find_harm(*h, weight_of_theta(options), many, &harm);
        double way = next_kink(kinks, places, gains, &harm, options->relative_tolerance, xi, 2 * *h) - xi;
        if (!many || way > *h / 2) return way;
    }
}

#endif
