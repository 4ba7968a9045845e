/* The wall around the body of the BHA: how far its points are from it, and which of them are watched. */
#ifndef BOREPROP_SURROUNDINGS_H
#define BOREPROP_SURROUNDINGS_H

#include "bit.h"

/* Add the offsets of the bit's axis from the hole at the points of the body, with the bit at `xi` in the state `x`. The
   hole ends where the step begins that is being tried. */
static inline void add_offsets(
    Integrator *p, const Step *step, double xi, const double x[COMPONENTS], int points, double *v
) {
    const Hole *hole = &p->now.hole;
    const double *s = p->scaled.s + p->scaled.n;
    int k = 0;
    for (; k < points && xi - s[k] >= step->xi; k++)
        v[k] += x[LATERAL] - polynomial(step->x[LATERAL], (xi - s[k] - step->xi) / step->h) - s[k] * x[ANGLE];
    for (; k < points; k++) {
        const Piece *own = piece(hole, p->cursor[k] = find_from(hole, p->cursor[k], xi - s[k]));
        v[k] += x[LATERAL] - polynomial(own->x[LATERAL], (xi - s[k] - own->start) * own->rate) - s[k] * x[ANGLE];
    }
}

#define NEARBY 2.0   /* a point is watched whose gap is less than so many times its change over the last step, … */
#define FAR_AWAY 4.0 /* … and no longer when it is more than so many times that */

/* How far every point of the body is from the wall with the bit at `xi` in a step. */
static inline void find_gaps(Integrator *p, const Step *step, double xi, int points, double gap[MAX_POINTS]) {
    const Contact *contact = &p->now.regime.contact;
    const double *y_star = p->scaled.y_star + p->scaled.n;
    double x[COMPONENTS], F[MAX_PLACES], v[MAX_POINTS];
    int n = p->scaled.n;
    step_state(step, xi, x);
    Loads loads = loads_at(p, xi, x, force_at(&p->now, xi));
    contact_forces(mode_of(&p->modes, *contact), &loads, F);
    free_deflections(&p->modes.beam, loads.e[n - 1], loads.F_rss, loads.g, n, points, v);
    for (int i = 0; i < loads.count; i++)
        if (F[i] != 0.0) add_push(&p->modes.beam, support_at(contact, n, i), F[i], points, v);
    add_offsets(p, step, xi, x, points, v);
    for (int k = 0; k < points; k++) gap[k] = y_star[k] - fabs(v[k]);
}

/* The same, and how much it has changed since the end of the last step. */
static inline void look_around(Integrator *p, const Step *step, Surroundings *around) {
    int points = p->scaled.points;
    find_gaps(p, step, step->end, points, around->gap);
    around->near = 0;
    for (int k = 0; k < points; k++) {
        around->change[k] = fabs(around->gap[k] - p->around.gap[k]);
        around->near |= around->gap[k] < NEARBY * around->change[k];
    }
}

/* Choose which points to watch from the end of the last step on. */
static inline void choose_watched(Integrator *p, double xi) {
    const Surroundings *around = &p->around;
    int n = p->scaled.n, changed = 0;
    if (!around->near && !p->now.regime.contact.watched) return;
    Contact contact = p->now.regime.contact;
    for (int k = 0; k < p->scaled.points; k++) {
        int place = place_of(&contact, n, k);
        double gap = around->gap[k], change = around->change[k];
        if (place < 0 && gap < NEARBY * change && contact.watched < MAX_WATCHED) watch(&contact, n, k, 0), changed = 1;
        else if (place >= 0 && !contact.of[place] && gap > FAR_AWAY * change) unwatch(&contact, n, place), changed = 1;
    }
    if (changed) change_places(p, contact, xi);
}

/* Watch every point that a trial step has brought through the wall unwatched, with the step to be tried again from `xi`;
   returns how many there are, or −1 if there is no room. */
static inline int watch_beyond(Integrator *p, const double gap[MAX_POINTS], double xi) {
    int n = p->scaled.n, found = 0;
    Contact contact = p->now.regime.contact;
    for (int k = 0; k < p->scaled.points; k++) {
        if (gap[k] >= 0 || place_of(&contact, n, k) >= 0) continue;
        if (contact.watched == MAX_WATCHED) return -1;
        watch(&contact, n, k, 0);
        found++;
    }
    if (found) change_places(p, contact, xi);
    return found;
}

/* Find all contacts of a BHA whose body may touch the wall, with the bit at `xi`, where the last step ends, in the state
   `x`. */
static inline Status touch_down(Integrator *p, double xi, const double x[COMPONENTS], Problem *problem) {
    int n = p->scaled.n, points = p->scaled.points;
    double q[MAX_SUPPORTS];
    Contact contact;
    Loads loads = loads_at(p, xi, x, force_at(&p->now, xi));
    free_deflections(&p->modes.beam, loads.e[n - 1], loads.F_rss, loads.g, 0, n + points, q);
    for (int i = 0; i < n; i++) q[i] += loads.e[i];
    add_offsets(p, &p->now.step, xi, x, points, q + n);
    if (!search(&p->modes, q, points, &contact)) return met(problem, TOO_CROWDED, MAX_WATCHED, xi * p->length_scale);
    change_places(p, contact, xi);
    return DONE;
}

#endif
