/* The body of the BHA between its stabilizers, which touches the wall where it has come to lie: a row of points, each with
   a clearance like that of a stabilizer. Most of them never touch. Those that do, or are near it, are watched: they have
   places in the regime. */
#ifndef BOREPROP_BODY_H
#define BOREPROP_BODY_H

#include "modes.h"

/* The contact forces in a mode. */
static inline void contact_forces(const Mode *mode, const Loads *loads, double F[MAX_PLACES]) {
    for (int i = 0; i < loads->count; i++) F[i] = mode->contact.of[i] ? row_value(&mode->F[i], loads) : 0.0;
}

/* What bends the BHA in one direction: the contact force at each place, e_n − δ_n, F_RSS, and g. */
typedef struct {
    int count; /* of places */
    double F[MAX_PLACES], end, F_rss, g;
} Pull;

/* How far the points of the body are from the bit's axis without a contact. */
static inline void free_deflections(const Beam *beam, const Pull *pull, int points, double *v) {
    const double *delta_e = beam->delta_e + beam->n, *delta_rss = beam->delta_rss + beam->n,
                 *delta_g = beam->delta_g + beam->n;
    double end = pull->end, F_rss = pull->F_rss, g = pull->g;
    for (int k = 0; k < points; k++) v[k] = delta_e[k] * end + delta_rss[k] * F_rss + delta_g[k] * g;
}

/* Add what a force on support j moves the points of the body by. They follow each other up the beam, so that up to some
   one they are below the force. */
static inline void add_push(const Beam *beam, int j, double F, int points, double *v) {
    const double *bent = beam->bent + beam->n, *sheared = beam->sheared + beam->n;
    const double *M_F = beam->M_F + beam->n, *F0_F = beam->F0_F + beam->n;
    double m = F * beam->M_F[j], q = F * beam->F0_F[j];
    double own_bent = F * beam->bent[j], own_sheared = F * beam->sheared[j];
    int below = 0;
    while (below < points && beam->node[beam->n + below] < beam->node[j]) below++;
    for (int k = 0; k < below; k++) v[k] += q * sheared[k] - m * bent[k];
    for (int k = below; k < points; k++) v[k] += F0_F[k] * own_sheared - M_F[k] * own_bent;
}

/* The place of a point in a regime; −1 if it has none. */
static inline int place_of(const Contact *contact, int n, int point) {
    for (int k = 0; k < contact->watched; k++)
        if (contact->point[k] == point) return n + k;
    return -1;
}

/* Watch a point: give it a place, in the order of the points. There must be room. */
static inline void watch(Contact *contact, int n, int point, int touching) {
    int k = contact->watched++;
    for (; k > 0 && contact->point[k - 1] > point; k--) {
        contact->point[k] = contact->point[k - 1];
        contact->of[n + k] = contact->of[n + k - 1];
    }
    contact->point[k] = (unsigned char)point, contact->of[n + k] = (signed char)touching;
}

/* Watch the point at a place no longer. */
static inline void unwatch(Contact *contact, int n, int place) {
    int last = --contact->watched;
    for (int k = place - n; k < last; k++) {
        contact->point[k] = contact->point[k + 1];
        contact->of[n + k] = contact->of[n + k + 1];
    }
    contact->point[last] = 0, contact->of[n + last] = 0;
}

/* What bends a beam with its supports: offsets of the bit's axis from the hole, F_RSS, g, and δ_n; and the clearances. */
typedef struct {
    double e[MAX_SUPPORTS], F_rss, g, end, y[MAX_SUPPORTS];
} Bent;

/* How it lies then: the force of each support that touches, the deflection of any other, and what the bit bears. */
typedef struct {
    double of[MAX_SUPPORTS], M, F_0;
} Lain;

/* Contacts as they are followed while loads and clearances change as `bent` + t `bending`: forces and deflections are then
   `start` + t `rate`. */
typedef struct {
    int n, supports, touching;
    signed char of[MAX_SUPPORTS];
    Bent bent, bending;
    Lain start, rate;
} Path;

/* How a chain lies under loads. */
static inline void lay_chain(const Chain *chain, const Path *path, const Bent *bent, Lain *lain) {
    Acting acting = {bent->g, bent->F_rss};
    Held held;
    for (int k = 0; k < chain->spans; k++) {
        int i = chain->held[k];
        held.v[k + 1] = i == path->n - 1 ? bent->end - bent->e[i] : -(bent->e[i] + path->of[i] * bent->y[i]);
    }
    hold(chain, acting, &held);
    for (int i = 0; i < path->supports; i++)
        if (i != path->n - 1) lain->of[i] = path->of[i] ? 0.0 : bent->e[i] + place_between(chain, &held, acting, i);
    for (int k = 0; k < chain->spans - 1; k++) lain->of[chain->held[k]] = held.F[k];
    lain->M = held.M, lain->F_0 = held.F_0;
}

/* Find start and rate for the contacts as they are; 0 if the beam buckles between them. */
static inline int look_ahead(const Beam *beam, Path *path) {
    Chain chain;
    if (!make_chain(&chain, beam, path->supports, path->of)) return 0;
    lay_chain(&chain, path, &path->bent, &path->start);
    lay_chain(&chain, path, &path->bending, &path->rate);
    return 1;
}

/* Where, from t on, a support meets a bound of its contact; infinity if it does not. */
static inline double leaves_at(const Path *path, int i, double t) {
    double start = path->start.of[i], rate = path->rate.of[i], y = path->bent.y[i], y_rate = path->bending.y[i];
    if (i == path->n - 1 || (y == 0.0 && y_rate == 0.0)) return INFINITY; /* held on both sides */
    if (path->of[i]) return path->of[i] * rate < 0 ? larger(-start / rate, t) : INFINITY;
    int side = rate > y_rate ? 1 : rate < -y_rate ? -1 : 0;
    if (!side) return INFINITY;
    return larger((side * y - start) / (rate - side * y_rate), t);
}

/* A support comes free, or touches the wall that it moves to; 0 if there is no room for it. */
static inline int switch_contact(Path *path, int i) {
    if (path->of[i]) path->of[i] = 0, path->touching--;
    else if (path->touching == MAX_WATCHED) return 0;
    else path->of[i] = path->rate.of[i] > 0 ? -1 : 1, path->touching++;
    return 1;
}

enum { MOST_SWITCHES = 10000 }; /* of a path: three as a rule, over a thousand in holes that no bit drills */

#define AJAR 1e-6 /* of clearances that open: from there on there is room to fall */

/* Loads and clearances at t. */
static inline Bent bent_at(const Path *path, double t) {
    Bent bent = path->bent;
    const Bent *bending = &path->bending;
    bent.F_rss += t * bending->F_rss, bent.g += t * bending->g, bent.end += t * bending->end;
    for (int i = 0; i < path->supports; i++) bent.e[i] += t * bending->e[i], bent.y[i] += t * bending->y[i];
    return bent;
}

/* Find where a beam goes that does not lie still: to its equilibrium between its contacts or, if it does not stand between
   these, on with the support that has come loose from `wall`. Returns the most of that way; 0 if there is none. */
static inline double way_of_fall(const Beam *beam, Path *fall, int loose, signed char wall) {
    Chain chain;
    Lain to;
    Bent inwards;
    if (make_chain(&chain, beam, fall->supports, fall->of)) {
        lay_chain(&chain, fall, &fall->bent, &to);
        for (int i = 0; i < fall->supports; i++) {
            if (fall->of[i]) fall->start.of[i] = to.of[i], fall->rate.of[i] = 0.0;
            else fall->rate.of[i] = to.of[i] - fall->start.of[i];
        }
        return 1.0;
    }
    memset(&inwards, 0, sizeof inwards);
    fall->of[loose] = wall, inwards.y[loose] = -1.0;
    if (!make_chain(&chain, beam, fall->supports, fall->of)) return 0.0;
    lay_chain(&chain, fall, &inwards, &fall->rate);
    for (int i = 0; i < fall->supports; i++)
        if (fall->of[i]) fall->rate.of[i] = 0.0;
    fall->of[loose] = 0, fall->rate.of[loose] = wall;
    return INFINITY;
}

/* The support that its wall pulls most, which a wall cannot; −1 if there is none. */
static inline int pulled_most(const Path *path) {
    int found = -1;
    double most = 0.0;
    for (int i = 0; i < path->supports; i++)
        if (path->bent.y[i] > 0 && path->of[i] * path->start.of[i] < most)
            most = path->of[i] * path->start.of[i], found = i;
    return found;
}

/* Let the beam fall to where it lies under the loads of the path, from where its supports are: held, or at `start`. The loose
   one has left `wall`, if there is one without which it does not stand. It takes a way on which its energy falls: supports
   that meet a wall stay there while others move, and come loose one after the other where the wall would have to pull.
   Returns what is in the way, as `follow`. */
static inline Code fall(const Beam *beam, Path *path, int loose, signed char wall) {
    for (int moves = 0; moves < MOST_SWITCHES; moves++) {
        int first = -1;
        double way = way_of_fall(beam, path, loose, wall);
        if (way == 0.0) break;
        for (int i = 0; i < path->supports; i++) {
            double at = leaves_at(path, i, 0.0);
            if (at < way) way = at, first = i;
        }
        for (int i = 0; i < path->supports; i++)
            if (!path->of[i]) path->start.of[i] += way * path->rate.of[i];
        if (first >= 0) {
            if (!switch_contact(path, first)) return TOO_CROWDED;
            continue;
        }
        loose = pulled_most(path);
        if (loose < 0) return NO_PROBLEM;
        wall = path->of[loose], path->start.of[loose] = -wall * path->bent.y[loose];
        path->of[loose] = 0, path->touching--;
    }
    return NO_MODE;
}

/* The same from a place on a path, where the support that is loose has left `wall`. */
static inline Code fall_at(const Beam *beam, Path *path, int loose, signed char wall, double t) {
    Path fallen = *path;
    fallen.bent = bent_at(path, t);
    for (int i = 0; i < path->supports; i++)
        fallen.start.of[i] = i == loose ? -wall * fallen.bent.y[i] : path->start.of[i] + t * path->rate.of[i];
    memset(&fallen.bending, 0, sizeof fallen.bending);
    Code problem = fall(beam, &fallen, loose, wall);
    memcpy(path->of, fallen.of, sizeof path->of), path->touching = fallen.touching;
    return problem;
}

/* Follow the contacts from t = 0 to 1, one switch after the other. Where a support comes free, so that the beam buckles, it
   falls to where it lies then. Returns what is in the way: TOO_CROWDED if more touch than there is room for, BUCKLES if the
   beam does between those that touch first, NO_MODE if there is no end; else NO_PROBLEM. */
static inline Code follow(const Beam *beam, Path *path) {
    double t = 0.0;
    int first = -1;
    signed char wall = 0;
    for (int switches = 0; switches < MOST_SWITCHES; switches++) {
        double next = 1.0;
        if (!look_ahead(beam, path)) {
            t = larger(t, AJAR);
            Code problem = wall ? fall_at(beam, path, first, wall, t) : BUCKLES;
            if (problem) return problem;
            wall = 0;
            continue;
        }
        first = -1;
        for (int i = 0; i < path->supports; i++) {
            double at = leaves_at(path, i, t);
            if (at < next) next = at, first = i;
        }
        if (first < 0) return NO_PROBLEM;
        wall = path->of[first];
        if (!switch_contact(path, first)) return TOO_CROWDED;
        t = next;
    }
    return NO_MODE;
}

/* The contacts of all supports under loads, whose clearances are those of the modes; returns what is in the way, as `follow`.

   First every stabilizer is held without clearance, so that the beam stands, and the load grows from nothing to its whole;
   then the clearances of the stabilizers open. */
static inline Code follow_load(const Modes *modes, const Bent *loads, int points, Path *path) {
    int n = modes->beam.n;
    memset(path, 0, sizeof *path);
    path->n = n, path->supports = n + points, path->bending = *loads;
    memset(path->bending.y, 0, sizeof path->bending.y);
    for (int i = 0; i < n - 1; i++) path->of[i] = 1, path->touching++;
    for (int i = n; i < path->supports; i++) path->bent.y[i] = modes->y_star[i];
    Code problem = follow(&modes->beam, path);
    if (problem) return problem;
    memcpy(path->bent.e, loads->e, sizeof loads->e);
    path->bent.F_rss = loads->F_rss, path->bent.g = loads->g, path->bent.end = loads->end;
    memset(&path->bending, 0, sizeof path->bending);
    for (int i = 0; i < n - 1; i++) {
        path->bending.y[i] = modes->y_star[i];
        if (modes->y_star[i] > 0) path->of[i] = path->start.of[i] + path->rate.of[i] < 0 ? -1 : 1;
    }
    return follow(&modes->beam, path);
}

/* The contacts under loads to which a beam comes from those that it has; BUCKLES if it does not stand between these. */
static inline Code lie_down(const Modes *modes, const Bent *loads, int points, const Contact *contact, Path *path) {
    int n = modes->beam.n;
    memset(path, 0, sizeof *path);
    path->n = n, path->supports = n + points, path->bent = *loads;
    memcpy(path->bent.y, modes->y_star, (size_t)path->supports * sizeof *modes->y_star);
    for (int i = 0; i < place_count(*contact, n); i++) path->of[support_at(contact, n, i)] = contact->of[i];
    for (int i = 0; i < n - 1; i++)
        if (path->bent.y[i] == 0.0) path->of[i] = 1;
    for (int i = 0; i < path->supports; i++) path->touching += path->of[i] != 0;
    if (!look_ahead(&modes->beam, path)) return BUCKLES;
    for (int i = 0; i < path->supports; i++) {
        double y = path->bent.y[i];
        if (!path->of[i]) path->start.of[i] = larger(-y, smaller(y, path->start.of[i]));
    }
    return fall(&modes->beam, path, -1, 0);
}

/* The contacts of all supports, as those of a regime: from those that there are if they are given and lead there. */
static inline Code search(const Modes *modes, const Bent *loads, int points, const Contact *from, Contact *found) {
    int n = modes->beam.n;
    Path path;
    Code problem = from ? lie_down(modes, loads, points, from, &path) : BUCKLES;
    if (problem) problem = follow_load(modes, loads, points, &path);
    if (problem) return problem;
    memset(found, 0, sizeof *found);
    for (int i = 0; i < n - 1; i++) found->of[i] = path.of[i];
    for (int k = 0; k < points; k++)
        if (path.of[n + k]) watch(found, n, k, path.of[n + k]);
    return NO_PROBLEM;
}

#endif
