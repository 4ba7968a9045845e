/* The wall around the body of the BHA: how far its points are from it, and which of them are watched. */
#ifndef BOREPROP_SURROUNDINGS_H
#define BOREPROP_SURROUNDINGS_H

#ifdef SPACE
#include "space_response.h"
#else
#include "response.h"
#endif

/* Where the hole is at a point of the body with the bit at `xi`. The hole ends where the step begins that is being tried. */
static inline void hole_at_point(Integrator *p, const Step *step, double xi, int k, double Y[DIRECTIONS]) {
    const Hole *hole = &p->now.hole;
    double at = xi - p->scaled.s[p->scaled.n + k];
    if (at >= step->xi) {
        double t = (at - step->xi) * (1 / step->h);
        for (int d = 0; d < DIRECTIONS; d++) Y[d] = polynomial(step->x[LATERAL + d], t);
        return;
    }
    p->seen.cursor[k] = find_near(hole, p->seen.cursor[k], at);
    piece_at(piece(hole, p->seen.cursor[k]), at, Y);
}

/* How far a point of the body, which is at `body`, is from the wall, the hole being at Y. */
static inline double gap_of(const Integrator *p, int k, double body[][MAX_POINTS], const double Y[DIRECTIONS]) {
    double off[DIRECTIONS];
    for (int d = 0; d < DIRECTIONS; d++) off[d] = body[d][k] - Y[d];
    return p->scaled.y_star[p->scaled.n + k] - length_of(off);
}

/* Where the points of the body are, from the origin, with the bit in the state `x`, bent like this. */
static inline void find_body_under(
    const Integrator *p, const double x[COMPONENTS], const Pull pull[DIRECTIONS], double body[][MAX_POINTS]
) {
    const Contact *contact = &p->now.regime.contact;
    const Beam *beam = &p->modes.beam;
    int n = p->scaled.n, points = p->scaled.points;
    const double *s = p->scaled.s + n;
    for (int d = 0; d < DIRECTIONS; d++) {
        free_deflections(beam, &pull[d], points, body[d]);
        for (int i = 0; i < pull[d].count; i++)
            if (pull[d].F[i] != 0.0) add_push(beam, support_at(contact, n, i), pull[d].F[i], points, body[d]);
        for (int k = 0; k < points; k++) body[d][k] += x[LATERAL + d] - s[k] * x[ANGLE + d];
    }
}

/* The same where a step ends that is being tried. */
static inline void find_body_after(Integrator *p, const Trial *trial, double body[][MAX_POINTS]) {
    double x[COMPONENTS];
    Pull pull[DIRECTIONS];
    step_state(&trial->step, trial->step.end, x);
    pull_after(p, trial, x, pull);
    find_body_under(p, x, pull, body);
}

/* The same with the bit at `xi` in a step. */
static inline void find_body_at(Integrator *p, const Step *step, double xi, double body[][MAX_POINTS]) {
    double x[COMPONENTS];
    Pull pull[DIRECTIONS];
    step_state(step, xi, x);
    pull_at(p, step, xi, x, pull);
    find_body_under(p, x, pull, body);
}

/* Where the hole is at every point of the body with the bit at `xi`, not beyond its end. */
static inline void hole_at_points(const Integrator *p, double xi, double Y[MAX_POINTS][DIRECTIONS]) {
    const Hole *hole = &p->now.hole;
    Count near = hole->end - 1;
    for (int k = 0; k < p->scaled.points; k++) {
        double at = xi - p->scaled.s[p->scaled.n + k];
        near = find_back(hole, near, at);
        piece_at(piece(hole, near), at, Y[k]);
    }
}

/* How far every point of the body is from the wall with the bit there, in the state `x`, and the BHA bent like this. */
static inline void find_gaps(
    const Integrator *p, double xi, const double x[COMPONENTS], const Pull pull[DIRECTIONS], double gap[MAX_POINTS]
) {
    double body[DIRECTIONS][MAX_POINTS], Y[MAX_POINTS][DIRECTIONS];
    find_body_under(p, x, pull, body);
    hole_at_points(p, xi, Y);
    for (int k = 0; k < p->scaled.points; k++) gap[k] = gap_of(p, k, body, Y[k]);
}

/* How near the body is to the wall there. */
static inline double wall_distance(
    const Integrator *p, double xi, const double x[COMPONENTS], const Pull pull[DIRECTIONS]
) {
    double gap[MAX_POINTS], least = INFINITY;
    find_gaps(p, xi, x, pull, gap);
    for (int k = 0; k < p->scaled.points; k++) least = smaller(least, gap[k]);
    return larger(least, 0.0);
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
    int anew = step->end - noted->since > reach + BLIND;
    if (anew) noted->since = step->xi;
    for (int d = 0; d < DIRECTIONS; d++) {
        Range nothing = {INFINITY, -INFINITY};
        if (anew) noted->before[d] = noted->latest[d], noted->latest[d] = nothing;
        widen(&noted->latest[d], step->x[LATERAL + d], 1 / step->h, (step->end - step->xi) / step->h);
    }
}

/* Forget where the hole was seen. */
static inline void forget_seen(Integrator *p) {
    for (int k = 0; k < p->scaled.points; k++) p->seen.at[k] = -INFINITY;
}

/* Note the inclinations of the existing hole. */
static inline void start_noting(State *now) {
    const Hole *hole = &now->hole;
    for (int d = 0; d < DIRECTIONS; d++) {
        Range range = {INFINITY, -INFINITY};
        for (Count k = hole->first; k < hole->end; k++)
            widen(&range, piece(hole, k)->x[LATERAL + d], piece(hole, k)->rate, 1.0);
        now->inclinations.before[d] = now->inclinations.latest[d] = range;
    }
    now->inclinations.since = now->xi;
}

/* Follow the origin of the lateral coordinates when it moves, so that a state `before` becomes `x`. */
static inline void move_seen(Integrator *p, const double before[COMPONENTS], const double x[COMPONENTS]) {
    if (!memcmp(before, x, COMPONENTS * sizeof *x)) return;
    for (int d = 0; d < DIRECTIONS; d++)
        for (int k = 0; k < p->scaled.points; k++) p->around.body[d][k] += x[LATERAL + d] - before[LATERAL + d];
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
    double middle[DIRECTIONS], half, start, end;
} Ahead;

static inline Ahead ahead_of(const Inclinations *noted, const Step *step) {
    Ahead ahead = {.start = step->xi, .end = step->end};
    double half[DIRECTIONS];
    for (int d = 0; d < DIRECTIONS; d++) {
        const Range *before = &noted->before[d], *latest = &noted->latest[d];
        double low = smaller(before->low, latest->low), high = larger(before->high, latest->high);
        ahead.middle[d] = (low + high) / 2, half[d] = (high - low) / 2;
    }
    ahead.half = length_of(half);
    return ahead;
}

/* By how much every point of the body, which is at `body` at the end of a step, is farther from the wall than where it would
   be near, at least. Negative where the hole has not been seen for long. */
static inline void find_margins(
    const Integrator *p, const Ahead *ahead, double (*restrict body)[MAX_POINTS], double *restrict margin
) {
    const double *restrict y_star = p->scaled.y_star + p->scaled.n, *restrict at = p->seen.at;
    const double (*restrict before)[MAX_POINTS] = p->around.body, (*restrict Y)[MAX_POINTS] = p->seen.Y;
    double half = ahead->half, end = ahead->end, h = end - ahead->start;
    int points = p->scaled.points;
    for (int k = 0; k < points; k++) {
        double way = end - at[k], off[DIRECTIONS], moved[DIRECTIONS];
        for (int d = 0; d < DIRECTIONS; d++) {
            off[d] = body[d][k] - Y[d][k] - ahead->middle[d] * way;
            moved[d] = body[d][k] - before[d][k] - ahead->middle[d] * h;
        }
        double gap = y_star[k] - length_of(off) - half * way, change = length_of(moved) + half * h;
        margin[k] = smaller(gap - TURNING * change, BLIND - way);
    }
}

/* Look at the hole at a point of the body, which is at `body` at the end of a step: how far it is from the wall and how much
   that has changed along the step, unless it is far from it. Returns whether it may have been at the wall within the step. */
static inline int look_at(Integrator *p, const Step *step, const Ahead *ahead, int k, double body[][MAX_POINTS]) {
    Seen *seen = &p->seen;
    Surroundings *around = &p->around;
    double h = ahead->end - ahead->start, Y[DIRECTIONS], before[DIRECTIONS], moved[DIRECTIONS], then = seen->at[k];
    hole_at_point(p, step, step->end, k, Y);
    for (int d = 0; d < DIRECTIONS; d++) {
        moved[d] = body[d][k] - around->body[d][k] - ahead->middle[d] * h;
        before[d] = seen->Y[d][k], seen->Y[d][k] = Y[d];
    }
    double gap = gap_of(p, k, body, Y), most = length_of(moved) + ahead->half * h;
    seen->at[k] = step->end;
    if (gap >= TURNING * most) return 0;
    if (then != step->xi) hole_at_point(p, step, step->xi, k, before);
    double start = gap_of(p, k, around->body, before);
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
static inline double least_gap(const Integrator *p, const Step *step, int k, const Arc body[DIRECTIONS]) {
    const Hole *hole = &p->now.hole;
    double s = p->scaled.s[p->scaled.n + k], y_star = p->scaled.y_star[p->scaled.n + k], length = step->end - step->xi;
    double at = step->xi - s, end = step->end - s, lowest = INFINITY;
    Count own = find_near(hole, p->seen.cursor[k], at);
    Arc gap = {0.0, 0.0, 0.0};
    for (int first = 1; at < end; first = 0, own++) {
        double next = own + 1 < hole->end ? piece(hole, own + 1)->start : step->xi; /* where the hole ends */
        next = at < next ? smaller(next, end) : end;
        double middle = (at + next) / 2, places[] = {at, middle, next}, gaps[3], off[DIRECTIONS];
        for (int i = 0; i < 3; i++) {
            if (i == 0 && !first) continue;
            const Piece *passed = piece(hole, own);
            for (int d = 0; d < DIRECTIONS; d++) {
                double Y = places[i] > step->xi
                               ? polynomial(step->x[LATERAL + d], (places[i] - step->xi) * (1 / step->h))
                               : polynomial(passed->x[LATERAL + d], (places[i] - passed->start) * passed->rate);
                off[d] = along(body[d], (places[i] + s - step->xi) / length) - Y;
            }
            gaps[i] = y_star - length_of(off);
        }
        gap.start = first ? gaps[0] : gap.end, gap.middle = gaps[1], gap.end = gaps[2];
        lowest = smaller(lowest, least(gap));
        at = next;
    }
    return lowest;
}

/* See which of `count` points of the body, which were not at the wall at the ends of a step, have been there within it. */
static inline void look_between(
    Integrator *p, const Step *step, int count, const int *turning, double body[][MAX_POINTS]
) {
    Surroundings *around = &p->around;
    double middle[DIRECTIONS][MAX_POINTS];
    find_body_at(p, step, (step->xi + step->end) / 2, middle);
    for (int i = 0; i < count; i++) {
        int k = turning[i];
        Arc arc[DIRECTIONS];
        for (int d = 0; d < DIRECTIONS; d++)
            arc[d].start = around->body[d][k], arc[d].middle = middle[d][k], arc[d].end = body[d][k];
        double lowest = least_gap(p, step, k, arc);
        if (lowest < 0) around->gap[k] = lowest, around->near = 1; /* it is watched, and the step tried again */
    }
}

/* See which points of the body are near the wall where a step ends that is being tried, with the points at `body`. */
static inline void look_around(Integrator *p, const Step *step, double body[][MAX_POINTS]) {
    const Contact *contact = &p->now.regime.contact;
    double margin[MAX_POINTS];
    int count = 0, turning[MAX_POINTS];
    Ahead ahead = ahead_of(&p->now.inclinations, step);
    if (p->around.known) clear_around(p);
    find_margins(p, &ahead, body, margin);
    for (int k = 0; k < p->scaled.points; k++) {
        if (margin[k] >= 0 || !look_at(p, step, &ahead, k, body)) continue;
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

#endif
