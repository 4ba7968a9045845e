/* The kinks of the hole, where a derivative of its lateral coordinate jumps. The stabilizers will pass them, and no step
   may pass over a kink that matters. */
#ifndef BOREPROP_KINKS_H
#define BOREPROP_KINKS_H

#include "system.h"

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
   two. The support at place i will next pass number ahead[i]. */
typedef struct {
    Kink *ring;
    Count capacity, end, ahead[MAX_PLACES];
} Kinks;

static inline Kink *kink(const Kinks *kinks, Count k) { return &kinks->ring[k & (kinks->capacity - 1)]; }

/* Number of the oldest kink that is kept: the one that the last stabilizer will pass next. */
static inline Count first_kink(const Kinks *kinks, int n) { return kinks->ahead[n - 1]; }

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

/* Where the next kink lies that a step of length `h` from `xi` must not pass; infinity if there is none. It may pass
   those that change it by less than the tolerance; `gains` are those of the law. */
static inline double next_kink(
    const Kinks *kinks, const Places *places, const double *gains, double tolerance, double xi, double h
) {
    double first = INFINITY, factorial[] = {1, 1, 2, 6, 24}, power[] = {1, h, h * h, h * h * h, h * h * h * h};
    for (int i = 0; i < places->count; i++)
        for (Count k = kinks->ahead[i]; k < kinks->end; k++) {
            const Kink *next = kink(kinks, k);
            double at = next->xi + places->s[i];
            int order = (int)next->order + 1;
            if (at >= xi + h || at >= first) break;
            if (gains[i] * next->jump * power[order] > tolerance * factorial[order]) first = at;
        }
    return first;
}

#endif
