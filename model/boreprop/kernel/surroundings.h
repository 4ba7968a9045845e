/* The wall around the body of the BHA: how far its points are from it, and which of them are watched. */
#ifndef BOREPROP_SURROUNDINGS_H
#define BOREPROP_SURROUNDINGS_H

#include "bit.h"

/* Where the hole is at a point of the body with the bit at `xi`. The hole ends where the step begins that is being tried;
   `nearer` is the piece at a point nearer to the bit, if one has been asked for. */
static inline double hole_at_point(const Integrator *p, const Step *step, double xi, int k, const Piece **nearer) {
    const Hole *hole = &p->now.hole;
    double at = xi - p->scaled.s[p->scaled.n + k];
    if (at >= step->xi) return polynomial(step->x[LATERAL], (at - step->xi) * (1 / step->h));
    if (!*nearer || (*nearer)->start > at) *nearer = piece(hole, find(hole, at));
    return polynomial((*nearer)->x[LATERAL], (at - (*nearer)->start) * (*nearer)->rate);
}

/* Where the points of the body are, from the origin, with the bit in the state `x`, under loads. */
static inline void find_body_under(Integrator *p, const double x[COMPONENTS], const Loads *loads, double *body) {
    const Contact *contact = &p->now.regime.contact;
    const Beam *beam = &p->modes.beam;
    int n = p->scaled.n, points = p->scaled.points;
    const double *s = p->scaled.s + n;
    double F[MAX_PLACES];
    contact_forces(mode_of(&p->modes, *contact), loads, F);
    free_deflections(beam, loads->e[n - 1], loads->F_rss, loads->g, n, points, body);
    for (int i = 0; i < loads->count; i++)
        if (F[i] != 0.0) add_push(beam, support_at(contact, n, i), F[i], points, body);
    for (int k = 0; k < points; k++) body[k] += x[LATERAL] - s[k] * x[ANGLE];
}

/* The same where a step ends that is being tried. */
static inline void find_body_after(Integrator *p, const Trial *trial, double *body) {
    const Step *step = &trial->step;
    const Places *places = &p->now.places;
    double x[COMPONENTS];
    step_state(step, step->end, x);
    Loads loads;
    if (step->event != NONE) loads = loads_at(p, step->end, x, force_at(&p->now, step->end));
    else { /* all of the trial, with its last point at the end */
        loads.count = places->count, loads.F_rss = force_at(&p->now, step->end);
        for (int i = 0; i < places->count; i++)
            loads.e[i] = x[LATERAL] - trial->delayed[i][0][POINTS - 1] - places->s[i] * x[ANGLE];
        loads.g = sin(p->scaled.axial ? x[ANGLE] : x[LATERAL] - trial->delayed[0][0][POINTS - 1]);
    }
    find_body_under(p, x, &loads, body);
}

/* The same with the bit at `xi` in a step. */
static inline void find_body_at(Integrator *p, const Step *step, double xi, double *body) {
    double x[COMPONENTS];
    step_state(step, xi, x);
    Loads loads = loads_at(p, xi, x, force_at(&p->now, xi));
    find_body_under(p, x, &loads, body);
}

/* How far every point of the body is from the wall with the bit where it is. */
static inline void find_gaps(Integrator *p, double gap[MAX_POINTS]) {
    const double *y_star = p->scaled.y_star + p->scaled.n;
    const Piece *nearer = NULL;
    double body[MAX_POINTS] = {0};
    find_body_at(p, &p->now.step, p->now.xi, body);
    for (int k = 0; k < p->scaled.points; k++)
        gap[k] = y_star[k] - fabs(body[k] - hole_at_point(p, &p->now.step, p->now.xi, k, &nearer));
}

/* Widen a range of inclinations by those of a piece of hole, the slopes of its polynomial up to t: they lie between the
   least and the largest of its coefficients in the basis of Bernstein. */
static inline void widen(Range *range, const double c[S + 1], double rate, double t) {
    static const double part[S][S] = {
        {1.0}, {1.0, 0.25}, {1.0, 0.5, 1.0 / 6}, {1.0, 0.75, 0.5, 0.25}, {1.0, 1.0, 1.0, 1.0, 1.0}
    };
    double slope[S], power = rate;
    for (int m = 0; m < S; m++) slope[m] = (m + 1) * c[m + 1] * power, power *= t;
    for (int i = 0; i < S; i++) {
        double bend = dot(i + 1, part[i], slope);
        range->low = smaller(range->low, bend), range->high = larger(range->high, bend);
    }
}

/* Note the inclinations of the hole over a step. */
static inline void note_inclinations(Inclinations *noted, const Step *step, double reach) {
    if (step->end - noted->since > reach + BLIND) {
        Range nothing = {INFINITY, -INFINITY};
        noted->before = noted->latest, noted->latest = nothing, noted->since = step->xi;
    }
    widen(&noted->latest, step->x[LATERAL], 1 / step->h, (step->end - step->xi) / step->h);
}

/* Forget where the hole was seen. */
static inline void forget_seen(Integrator *p) {
    for (int k = 0; k < p->scaled.points; k++) p->seen.at[k] = -INFINITY;
}

/* Note the inclinations of the existing hole. */
static inline void start_noting(State *now) {
    const Hole *hole = &now->hole;
    Range range = {INFINITY, -INFINITY};
    for (Count k = hole->first; k < hole->end; k++)
        widen(&range, piece(hole, k)->x[LATERAL], piece(hole, k)->rate, 1.0);
    now->inclinations.before = now->inclinations.latest = range, now->inclinations.since = now->xi;
}

/* Follow the origin of the lateral coordinates when it moves, so that they all change by `shift`. */
static inline void move_seen(Integrator *p, double shift) {
    for (int k = 0; k < p->scaled.points; k++) p->around.body[k] += shift;
    forget_seen(p);
}

/* No point of the body is near the wall. */
static inline void clear_around(Integrator *p) {
    Surroundings *around = &p->around;
    around->near = around->known = 0;
    for (int k = 0; k < p->scaled.points; k++)
        around->gap[k] = p->scaled.y_star[p->scaled.n + k], around->change[k] = -1.0;
}

#define NEARBY 0.5   /* a point is watched whose gap is less than so many times its change over the last step, … */
#define FAR_AWAY 4.0 /* … and no longer when it is more than so many times that */
/* The gap may have been less within a step by half of the most that it can have changed, where it turned round, and at the
   start of the step it may have been less by all of that. */
#define TURNING 1.5

/* What is known of a step before the hole is looked at: that its inclination at the points is `middle`, give or take `half`. */
typedef struct {
    double middle, half, start, end;
} Ahead;

static inline Ahead ahead_of(const Inclinations *noted, const Step *step) {
    double low = smaller(noted->before.low, noted->latest.low), high = larger(noted->before.high, noted->latest.high);
    Ahead ahead = {(low + high) / 2, (high - low) / 2, step->xi, step->end};
    return ahead;
}

/* By how much every point of the body, which is at `body` at the end of a step, is farther from the wall than where it would
   be near, at least. Negative where the hole has not been seen for long. */
static inline void find_margins(
    const Integrator *p, const Ahead *ahead, const double *restrict body, double *restrict margin
) {
    const double *restrict y_star = p->scaled.y_star + p->scaled.n, *restrict before = p->around.body;
    const double *restrict Y = p->seen.Y, *restrict at = p->seen.at;
    double middle = ahead->middle, half = ahead->half, end = ahead->end, h = end - ahead->start;
    int points = p->scaled.points;
    for (int k = 0; k < points; k++) {
        double way = end - at[k];
        double gap = y_star[k] - fabs(body[k] - Y[k] - middle * way) - half * way;
        double change = fabs(body[k] - before[k] - middle * h) + half * h;
        margin[k] = smaller(gap - TURNING * change, BLIND - way);
    }
}

/* Look at the hole at a point of the body, which is at `body` at the end of a step: how far it is from the wall and how much
   that has changed along the step, unless it is far from it. Returns whether it may have been at the wall within the step. */
static inline int look_at(
    Integrator *p, const Step *step, const Ahead *ahead, int k, double body, const Piece **nearer
) {
    Seen *seen = &p->seen;
    Surroundings *around = &p->around;
    double y_star = p->scaled.y_star[p->scaled.n + k], h = ahead->end - ahead->start;
    double Y = hole_at_point(p, step, step->end, k, nearer), before = seen->Y[k], then = seen->at[k];
    double gap = y_star - fabs(body - Y);
    double most = fabs(body - around->body[k] - ahead->middle * h) + ahead->half * h;
    const Piece *none = NULL;
    seen->Y[k] = Y, seen->at[k] = step->end;
    if (gap >= TURNING * most) return 0;
    if (then != step->xi) before = hole_at_point(p, step, step->xi, k, &none);
    double start = y_star - fabs(around->body[k] - before);
    around->gap[k] = gap, around->change[k] = fabs(gap - start);
    around->near |= gap < NEARBY * around->change[k];
    around->known = 1;
    return smaller(gap, start) < most / 2;
}

/* A quantity along a step: its values at the start, in the middle and at the end. */
typedef struct {
    double start, middle, end;
} Arc;

/* Its value at t, from 0 to 1, by a parabola. */
static inline double along(Arc arc, double t) {
    double bend = 2 * (arc.start - 2 * arc.middle + arc.end);
    return arc.start + t * (arc.end - arc.start + (t - 1) * bend);
}

/* The least of it within the step, or at its end. */
static inline double least(Arc arc) {
    double rise = (arc.end - arc.start) / 2, bend = arc.start - 2 * arc.middle + arc.end;
    return bend > fabs(rise) ? arc.middle - rise * rise / (2 * bend) : smaller(arc.middle, arc.end);
}

/* The least gap of a point within a step, along which it moves as `body`, piece by piece of the hole that it passes. */
static inline double least_gap(const Integrator *p, const Step *step, int k, Arc body) {
    const Hole *hole = &p->now.hole;
    double s = p->scaled.s[p->scaled.n + k], y_star = p->scaled.y_star[p->scaled.n + k], length = step->end - step->xi;
    double at = step->xi - s, end = step->end - s, lowest = INFINITY;
    Count own = find(hole, at);
    Arc gap = {0.0, 0.0, 0.0};
    for (int first = 1; at < end; first = 0, own++) {
        double next = own + 1 < hole->end ? smaller(piece(hole, own + 1)->start, end) : end;
        double middle = (at + next) / 2, places[] = {at, middle, next}, gaps[3];
        for (int i = 0; i < 3; i++) {
            if (i == 0 && !first) continue;
            const Piece *passed = piece(hole, own);
            double Y = places[i] > step->xi
                           ? polynomial(step->x[LATERAL], (places[i] - step->xi) * (1 / step->h))
                           : polynomial(passed->x[LATERAL], (places[i] - passed->start) * passed->rate);
            gaps[i] = y_star - fabs(along(body, (places[i] + s - step->xi) / length) - Y);
        }
        gap.start = first ? gaps[0] : gap.end, gap.middle = gaps[1], gap.end = gaps[2];
        lowest = smaller(lowest, least(gap));
        at = next;
    }
    return lowest;
}

/* See which of `count` points of the body, which were not at the wall at the ends of a step, have been there within it. */
static inline void look_between(Integrator *p, const Step *step, int count, const int *turning, const double *body) {
    Surroundings *around = &p->around;
    double middle[MAX_POINTS];
    find_body_at(p, step, (step->xi + step->end) / 2, middle);
    for (int i = 0; i < count; i++) {
        int k = turning[i];
        Arc arc = {around->body[k], middle[k], body[k]};
        around->gap[k] = smaller(around->gap[k], least_gap(p, step, k, arc));
        around->near |= around->gap[k] < 0;
    }
}

/* See which points of the body are near the wall where a step ends that is being tried, with the points at `body`. */
static inline void look_around(Integrator *p, const Step *step, const double *body) {
    const Contact *contact = &p->now.regime.contact;
    const Piece *nearer = NULL;
    double margin[MAX_POINTS];
    int count = 0, turning[MAX_POINTS];
    Ahead ahead = ahead_of(&p->now.inclinations, step);
    if (p->around.known) clear_around(p);
    find_margins(p, &ahead, body, margin);
    for (int k = 0; k < p->scaled.points; k++) {
        if (margin[k] >= 0 || !look_at(p, step, &ahead, k, body[k], &nearer)) continue;
        if (place_of(contact, p->scaled.n, k) < 0) turning[count++] = k;
    }
    if (count) look_between(p, step, count, turning, body);
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
   returns how many there are, or −1 if there is no room for all, and then none is. */
static inline int watch_beyond(Integrator *p, double xi) {
    int n = p->scaled.n, found = 0;
    Contact contact = p->now.regime.contact;
    for (int k = 0; k < p->scaled.points; k++) {
        if (p->around.gap[k] >= 0 || place_of(&contact, n, k) >= 0) continue;
        if (contact.watched == MAX_WATCHED) return -1;
        watch(&contact, n, k, 0);
        found++;
    }
    if (found) change_places(p, contact, xi);
    return found;
}

/* Find all contacts of a BHA whose body may touch the wall, with the bit at `xi`, where the last step ends, in the state
   `x`. Points that are watched stay so. */
static inline Status touch_down(Integrator *p, double xi, const double x[COMPONENTS], Problem *problem) {
    int n = p->scaled.n, points = p->scaled.points;
    const Contact *now = &p->now.regime.contact;
    const Piece *nearer = NULL;
    Bent bent = {.end = p->modes.beam.end};
    Contact contact;
    Loads loads = loads_at(p, xi, x, force_at(&p->now, xi));
    bent.F_rss = loads.F_rss, bent.g = loads.g;
    memcpy(bent.e, loads.e, (size_t)n * sizeof *bent.e);
    for (int k = 0; k < points; k++)
        bent.e[n + k] = x[LATERAL] - hole_at_point(p, &p->now.step, xi, k, &nearer) - p->scaled.s[n + k] * x[ANGLE];
    Code code = search(&p->modes, &bent, points, &contact);
    if (code) {
        double tolerance = p->options.relative_tolerance, place = xi * p->length_scale;
        return no_contacts(code, &p->scaled, p->modes.axial, p->force_scale, tolerance, place, problem);
    }
    for (int k = 0; k < now->watched && contact.watched < MAX_WATCHED; k++)
        if (place_of(&contact, n, now->point[k]) < 0) watch(&contact, n, now->point[k], 0);
    change_places(p, contact, xi);
    return DONE;
}

#endif
