/* Where a BHA whose body may touch the wall comes to lie in the hole: all its contacts, in space. */
#ifndef BOREPROP_SPACE_LANDING_H
#define BOREPROP_SPACE_LANDING_H

#include "surroundings.h"

/* Whether contacts are searched for among all supports; without a body they follow from those of the stabilizers. */
static inline int lands(const Integrator *p) { return p->scaled.points > 0; }

#define BEYOND 1e-12 /* ℓ₁: a point this far in the wall is there by rounding */

/* Watch the points of the body that are deepest in the wall, one of each row of neighbours that are in it, or −1 if there is
   no room for one; returns how many. Points that touch nothing make room. */
static inline int watch_deepest(Integrator *p, double xi, const double gap[MAX_POINTS]) {
    int n = p->scaled.n, found = 0;
    Contact contact = p->now.regime.contact;
    for (int k = 0; k < p->scaled.points; k++) {
        double before = k > 0 ? gap[k - 1] : INFINITY, after = k + 1 < p->scaled.points ? gap[k + 1] : INFINITY;
        if (gap[k] >= -BEYOND || gap[k] > before || gap[k] >= after || place_of(&contact, n, k) >= 0) continue;
        for (int i = n; i < place_count(contact, n) && contact.watched == MAX_WATCHED; i++)
            if (!contact.of[i]) unwatch(&contact, n, i);
        if (contact.watched == MAX_WATCHED) return -1;
        watch(&contact, n, k, TOUCHES), found++;
    }
    if (found) change_places(p, contact, xi);
    return found;
}

/* Find all contacts with the bit at `xi`, where the last step ends, in the state `x`. The minimum that the contact forces are
   is unique, so that it is found by taking in, again and again, points that are in the wall without one. */
static inline Status touch_down(Integrator *p, double xi, const double x[COMPONENTS], int anew, Problem *problem) {
    (void)anew;
    for (int round = 0; round <= p->scaled.points; round++) {
        double gap[MAX_POINTS];
        Pull pull[DIRECTIONS];
        Response is = respond_at(p, &p->now.step, xi, x, inputs_at(&p->now, xi));
        change_regime(p, is.regime);
        pull_under(p, &is, pull);
        find_gaps(p, xi, x, pull, gap);
        int found = watch_deepest(p, xi, gap);
        if (!found) return DONE;
        if (found < 0) break;
    }
    return met(problem, TOO_CROWDED, MAX_WATCHED, xi * p->length_scale);
}

#endif
