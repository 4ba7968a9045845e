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

/* How far `count` supports from `first` on are from the bit's axis without a contact. */
static inline void free_deflections(
    const Beam *beam, double e_n, double F_rss, double g, int first, int count, double *v
) {
    const double *delta_e = beam->delta_e + first, *delta_rss = beam->delta_rss + first,
                 *delta_g = beam->delta_g + first;
    for (int k = 0; k < count; k++) v[k] = delta_e[k] * (e_n - beam->end) + delta_rss[k] * F_rss + delta_g[k] * g;
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

/* Contacts as they are followed while deflections without contact and clearances change: those are q + t q_rate and
   y + t y_rate, and force or deflection of each support, as it touches or not, is start + t rate. */
typedef struct {
    int n, supports, touching, C[MAX_PLACES];
    signed char of[MAX_SUPPORTS];
    double q[MAX_SUPPORTS], q_rate[MAX_SUPPORTS], y[MAX_SUPPORTS], y_rate[MAX_SUPPORTS];
    double start[MAX_SUPPORTS], rate[MAX_SUPPORTS];
} Path;

/* Find start and rate for the contacts as they are. */
static inline void look_ahead(const Beam *beam, Path *path) {
    double K_inv_CC[SIZE][SIZE] = {{0}}, K_C[SIZE][SIZE] = {{0}};
    const int *C = path->C, touching = path->touching;
    for (int k = 0; k < touching; k++)
        for (int l = 0; l < touching; l++) K_inv_CC[k][l] = compliance(beam, C[k], C[l]);
    inverse(touching, (const double (*)[SIZE])K_inv_CC, K_C);
    for (int k = 0; k < touching; k++) {
        double start = 0.0, rate = 0.0;
        for (int l = 0; l < touching; l++) {
            int i = C[l];
            start -= K_C[k][l] * (path->q[i] + path->of[i] * path->y[i]);
            rate -= K_C[k][l] * (path->q_rate[i] + path->of[i] * path->y_rate[i]);
        }
        path->start[C[k]] = start, path->rate[C[k]] = rate;
    }
    for (int i = 0; i < path->supports; i++) {
        if (path->of[i]) continue;
        path->start[i] = path->q[i], path->rate[i] = path->q_rate[i];
        for (int k = 0; k < touching; k++) {
            path->start[i] += compliance(beam, i, C[k]) * path->start[C[k]];
            path->rate[i] += compliance(beam, i, C[k]) * path->rate[C[k]];
        }
    }
}

/* Where, from t on, a support meets a bound of its contact; infinity if it does not. */
static inline double leaves_at(const Path *path, int i, double t) {
    double start = path->start[i], rate = path->rate[i];
    if (i == path->n - 1 || (path->y[i] == 0.0 && path->y_rate[i] == 0.0)) return INFINITY; /* held on both sides */
    if (path->of[i]) return path->of[i] * rate < 0 ? larger(-start / rate, t) : INFINITY;
    int side = rate > path->y_rate[i] ? 1 : rate < -path->y_rate[i] ? -1 : 0;
    if (!side) return INFINITY;
    return larger((side * path->y[i] - start) / (rate - side * path->y_rate[i]), t);
}

/* A support comes free, or touches the wall that it moves to; 0 if there is no room for it. */
static inline int switch_contact(Path *path, int i) {
    if (!path->of[i]) {
        if (path->touching == MAX_WATCHED) return 0;
        path->of[i] = path->rate[i] > 0 ? -1 : 1;
        path->C[path->touching++] = i;
        return 1;
    }
    int k = 0;
    while (path->C[k] != i) k++;
    path->C[k] = path->C[--path->touching];
    path->of[i] = 0;
    return 1;
}

enum { MOST_SWITCHES = 1000 }; /* of a path: it takes three as a rule, and under a hundred where nearly all touch */

/* Follow the contacts from t = 0 to 1, one switch after the other; 0 if more touch than there is room for, or there is no
   end. */
static inline int follow(const Beam *beam, Path *path) {
    double t = 0.0;
    for (int switches = 0; switches < MOST_SWITCHES; switches++) {
        int first = -1;
        double next = 1.0;
        look_ahead(beam, path);
        for (int i = 0; i < path->supports; i++) {
            double at = leaves_at(path, i, t);
            if (at < next) next = at, first = i;
        }
        if (first < 0) return 1;
        if (!switch_contact(path, first)) return 0;
        t = next;
    }
    return 0;
}

/* The contacts of all supports under the deflections q̃ that the beam would have without any; 0 if more touch than there
   is room for, or none are found.

   First every stabilizer is held without clearance, so that the beam stands, and the load grows from nothing to its whole;
   then the clearances of the stabilizers open. */
static inline int follow_load(const Modes *modes, const double q[MAX_SUPPORTS], int points, Path *path) {
    int n = modes->beam.n;
    memset(path, 0, sizeof *path);
    path->n = n, path->supports = n + points;
    for (int i = 0; i < n - 1; i++) path->of[i] = 1, path->C[path->touching++] = i;
    for (int i = 0; i < path->supports; i++) path->q_rate[i] = q[i], path->y[i] = i < n ? 0.0 : modes->y_star[i];
    if (!follow(&modes->beam, path)) return 0;
    for (int i = 0; i < path->supports; i++) path->q[i] = q[i], path->q_rate[i] = 0.0;
    for (int i = 0; i < n - 1; i++) {
        path->y_rate[i] = modes->y_star[i];
        if (path->y_rate[i] > 0) path->of[i] = path->start[i] + path->rate[i] < 0 ? -1 : 1;
    }
    return follow(&modes->beam, path);
}

/* The same, as the contacts of a regime. */
static inline int search(const Modes *modes, const double q[MAX_SUPPORTS], int points, Contact *found) {
    int n = modes->beam.n;
    Path path;
    if (!follow_load(modes, q, points, &path)) return 0;
    memset(found, 0, sizeof *found);
    for (int i = 0; i < n - 1; i++) found->of[i] = path.of[i];
    for (int k = 0; k < points; k++)
        if (path.of[n + k]) watch(found, n, k, path.of[n + k]);
    return 1;
}

#endif
