/* The state of a drilling run as numbers. It is checked when it is restored, since the numbers may come from anywhere.

   First come the numbers of which there is a fixed count, then the pieces of the hole, then the kinks. */
#ifndef BOREPROP_STATE_H
#define BOREPROP_STATE_H

#include "drilling.h"
#include <limits.h>

#define ROUNDING_OF_XI 1e-15 /* relative, where ξ is a length over ℓ₁ or the length ξ times ℓ₁ */

/* Numbers are written `to` it or read `from` it; if it is neither, they are only counted. */
typedef struct {
    double *to;
    const double *from;
    Count passed, most; /* how many numbers there are to read */
    int sound;          /* whether all whole numbers so far are whole and within their limits */
} Tape;

enum { NUMBERS_OF_PIECE = sizeof(Piece) / sizeof(double), NUMBERS_OF_KINK = sizeof(Kink) / sizeof(double) };
enum { NUMBERS_OF_INCLINATIONS = sizeof(Inclinations) / sizeof(double) };
enum { NUMBERS_OF_INPUTS = sizeof(ScaledInputs) / sizeof(double) };

/* Everything that evolves, with counts in place of the rings. */
typedef struct {
    double drilled_length;
    State now;
    Count pieces, kinks, passed[MAX_PLACES]; /* passed: how many of the kinks the support at each place has passed */
    Surroundings around;
} Snapshot;

static inline void pass(Tape *tape, int count, double *values) {
    size_t size = (size_t)count * sizeof *values;
    if (tape->from && count > tape->most - tape->passed) {
        tape->sound = 0;
        return;
    }
    if (tape->to) memcpy(tape->to + tape->passed, values, size);
    if (tape->from) memcpy(values, tape->from + tape->passed, size);
    tape->passed += count;
}

/* A whole number. If the number read is not whole, or beyond its limits, the tape is not sound, and the lower limit is
   taken instead. */
static inline Count pass_whole(Tape *tape, Count value, Count least, Count most) {
    double number = (double)value;
    pass(tape, 1, &number);
    if (number >= (double)least && number <= (double)most && number == floor(number)) return (Count)number;
    tape->sound = 0;
    return least;
}

static inline void pass_piece(Tape *tape, Piece *piece) { pass(tape, NUMBERS_OF_PIECE, (double *)piece); }

static inline void pass_kink(Tape *tape, Kink *kink) { pass(tape, NUMBERS_OF_KINK, (double *)kink); }

/* The contacts, and which points of the body are watched, in their order. */
static inline void pass_contact(Tape *tape, const Scaled *scaled, Contact *contact) {
    int n = scaled->n, least = 0;
    contact->watched = (unsigned char)pass_whole(
        tape, contact->watched, 0, scaled->points < MAX_WATCHED ? scaled->points : MAX_WATCHED
    );
    for (int k = 0; k < contact->watched; k++) {
        contact->point[k] = (unsigned char)pass_whole(tape, contact->point[k], least, scaled->points - 1);
        least = contact->point[k] + 1;
    }
    for (int i = 0; i < place_count(*contact, n); i++)
        contact->of[i] = (signed char)pass_whole(tape, contact->of[i], -1, 1);
}

/* All numbers but pieces and kinks. Only the first one may be infinite. */
static inline void pass_snapshot(Tape *tape, const Scaled *scaled, Snapshot *snapshot) {
    int n = scaled->n;
    State *now = &snapshot->now;
    Step *step = &now->step;
    pass(tape, 1, &step->next_h);
    snapshot->pieces = pass_whole(tape, snapshot->pieces, 1, MOST_PIECES);
    snapshot->kinks = pass_whole(tape, snapshot->kinks, 0, MOST_PIECES);
    now->kinks.many = (int)pass_whole(tape, now->kinks.many, DIRECTIONS > 1, 1);
    pass_contact(tape, scaled, &now->regime.contact);
    for (int i = 0; i < place_count(now->regime.contact, n); i++)
        snapshot->passed[i] = pass_whole(tape, snapshot->passed[i], 0, snapshot->kinks);
    now->regime.saturation = (int)pass_whole(tape, now->regime.saturation, -1, 1);
    step->event = (int)pass_whole(tape, step->event, NONE, place_count(now->regime.contact, n) - 1);
    step->side = (int)pass_whole(tape, step->side, -1, 1);
    pass(tape, 1, &snapshot->drilled_length);
    pass(tape, 1, &now->xi);
    pass(tape, NUMBERS_OF_INPUTS, &now->inputs.F_rss);
#ifdef SPACE
    for (int axis = NORTH; axis <= DOWN; axis++) pass(tape, 3, step->frame.row[axis]);
#endif
    pass(tape, 1, &now->cosine);
    pass(tape, 1, &now->inputs_xi);
    now->layer = (int)pass_whole(tape, now->layer, 0, MOST_PIECES);
    pass(tape, 1, &now->stay);
    pass(tape, 1, &now->cleared);
    pass(tape, n - 1, now->y_star);
    pass(tape, AXES, step->path);
    pass(tape, DIRECTIONS, now->origin);
    pass(tape, 1, &step->xi);
    pass(tape, 1, &step->h);
    for (int c = 0; c < COMPONENTS; c++) pass(tape, S + 1, step->x[c]);
    pass(tape, 1, &step->end);
    pass(tape, 1, &now->accepted);
    pass(tape, 1, &now->rejected);
    pass(tape, 1, &now->events);
    for (int i = 0; i < scaled->sensors; i++) {
        Reading *reading = &now->reading[i];
        reading->count = (double)pass_whole(tape, (Count)reading->count, 0, (Count)MOST_READINGS + 1);
        pass(tape, DIRECTIONS, reading->told);
    }
    if (!scaled->points) return;
    pass(tape, NUMBERS_OF_INCLINATIONS, &now->inclinations.before[0].low);
    for (int d = 0; d < DIRECTIONS; d++) pass(tape, scaled->points, snapshot->around.body[d]);
    pass(tape, scaled->points, snapshot->around.gap);
    pass(tape, scaled->points, snapshot->around.change);
}

static inline Snapshot snapshot_of(const Drilling *d) {
    const State *now = &d->integrator.now;
    int n = d->system.structure.n;
    Count oldest = first_kink(&now->kinks, n);
    Snapshot snapshot = {d->drilled_length,       *now, now->hole.end - now->hole.first,
                         now->kinks.end - oldest, {0},  d->integrator.around};
    for (int i = 0; i < now->places.count; i++) snapshot.passed[i] = now->kinks.ahead[i] - oldest;
    return snapshot;
}

/* How many numbers a state has that consists of a snapshot, pieces and kinks. */
static inline Count state_size(const Scaled *scaled, const Snapshot *snapshot) {
    Tape count = {NULL, NULL, 0, 0, 1};
    Snapshot any = *snapshot;
    pass_snapshot(&count, scaled, &any);
    return count.passed + NUMBERS_OF_PIECE * any.pieces + NUMBERS_OF_KINK * any.kinks;
}

/* How many numbers `drilling_save` writes. */
static inline Count drilling_state_size(const Drilling *d) {
    Snapshot snapshot = snapshot_of(d);
    return state_size(&d->integrator.scaled, &snapshot);
}

/* Write everything that evolves. */
static inline void drilling_save(const Drilling *d, double *state) {
    const State *now = &d->integrator.now;
    Snapshot snapshot = snapshot_of(d);
    Tape tape = {state, NULL, 0, 0, 1};
    pass_snapshot(&tape, &d->integrator.scaled, &snapshot);
    for (Count k = now->hole.first; k < now->hole.end; k++) pass_piece(&tape, piece(&now->hole, k));
    for (Count k = first_kink(&now->kinks, d->system.structure.n); k < now->kinks.end; k++)
        pass_kink(&tape, kink(&now->kinks, k));
}

#define UPRIGHT 1e-9 /* what a frame may lack to be one, far above rounding */

/* Whether the frame of a step is one. */
static inline int is_turned(const Step *step) {
#ifdef SPACE
    Frame straight = step->frame;
    straighten(&straight);
    for (int axis = NORTH; axis <= DOWN; axis++)
        for (int k = 0; k < 3; k++)
            if (!(fabs(straight.row[axis][k] - step->frame.row[axis][k]) <= UPRIGHT)) return 0;
#else
    (void)step;
#endif
    return 1;
}

/* Whether the numbers other than pieces and kinks agree with each other. */
static inline int is_consistent(const Drilling *d, const Snapshot *snapshot) {
    const State *now = &snapshot->now;
    const Step *step = &now->step;
    double xi = now->xi;
    ScaledInputs here = inputs_here(now);
    if (!(fabs(snapshot->drilled_length / length_scale(&d->system) - xi) <= ROUNDING_OF_XI * xi)) return 0;
    if (!(here.eta_pi > 0) || !isfinite(1 / here.eta_pi) || now->inputs_xi > xi) return 0;
    if (!(here.chi_pi > 0) || !isfinite(1 / here.chi_pi) || !(here.psi_star > 0)) return 0;
    if (d->system.structure.axial ? !(now->inputs.W > 0) || !(fabs(now->cosine) <= 1)
                                  : now->inputs.W != 0 || now->cosine != 0)
        return 0;
    if (now->layer > d->ground.layers || now->cleared > xi || !is_turned(step)) return 0;
    for (int i = 0; i < d->system.structure.n - 1; i++)
        if (!(now->y_star[i] >= 0)) return 0;
    if (step->xi > xi || xi > step->end || !(step->h > 0) || !(step->next_h > 0)) return 0;
    return snapshot->passed[d->system.structure.n - 1] == 0; /* the last stabilizer is the last to pass a kink */
}

/* Whether the state at the end of a piece, at `end`, is where the next piece begins with `x`. */
static inline int is_joined(const Piece *piece, double end, double x[COMPONENTS][S + 1]) {
    if (!(piece->rate > 0) || end < piece->start) return 0;
    for (int c = LATERAL; c < COMPONENTS; c++)
        if (!(fabs(polynomial(piece->x[c], (end - piece->start) * piece->rate) - x[c][0]) <= MERGE)) return 0;
    return 1;
}

/* Whether the pieces join to one hole, whose last piece is the present step unless that has no length, and the kinks are
   of an order that is followed. */
static inline int is_hole(Snapshot *snapshot, Tape tape) {
    Step *step = &snapshot->now.step;
    Piece own = {0}, next = {0};
    Kink kink = {0};
    pass_piece(&tape, &own);
    for (Count left = snapshot->pieces - 1; left > 0; left--, own = next) {
        pass_piece(&tape, &next);
        if (!(own.inputs.eta_pi >= 0) || !is_joined(&own, next.start, next.x)) return 0;
    }
    if (!(own.inputs.eta_pi >= 0) || !is_joined(&own, step->xi, step->x)) return 0;
    int stands = step->end == step->xi;
    /* not own.rate != 1 / step->h, which a processor that computes with more than 64 bits finds of every step */
    if (!stands && (own.start != step->xi || !(fabs(own.rate * step->h - 1) <= DBL_EPSILON))) return 0;
    if (!stands && memcmp(own.x, step->x, sizeof own.x)) return 0;
    for (Count left = snapshot->kinks; left > 0; left--) {
        pass_kink(&tape, &kink);
        if (kink.order != floor(kink.order) || kink.order < 1 || kink.order > SMOOTHEST_KINK) return 0;
    }
    return 1;
}

/* Read a state up to its pieces and kinks, before which the tape then stands; 0 if the numbers cannot be a state. */
static inline int read_state(const Drilling *d, Count count, Tape *tape, Snapshot *snapshot) {
    const Scaled *scaled = &d->integrator.scaled;
    Snapshot least = {0};
    least.pieces = 1;
    if (count < state_size(scaled, &least)) return 0;
    pass_snapshot(tape, scaled, snapshot);
    if (!tape->sound || state_size(scaled, snapshot) != count) return 0;
    for (Count k = 1; k < count; k++)
        if (!isfinite(tape->from[k])) return 0;
    return is_consistent(d, snapshot) && is_hole(snapshot, *tape);
}

/* The capacity that a state needs. */
static inline Count snapshot_capacity(const Snapshot *snapshot) {
    Count most = snapshot->pieces > snapshot->kinks ? snapshot->pieces : snapshot->kinks, capacity = LEAST_CAPACITY;
    while (capacity < 2 * most + 2) capacity *= 2;
    return capacity;
}

/* Become what a snapshot says, with the pieces and kinks on the tape; the rings must have room for them. */
static inline void become(Drilling *d, const Snapshot *snapshot, Tape tape) {
    Integrator *p = &d->integrator;
    Hole hole = {p->now.hole.ring, p->now.hole.capacity, 0, snapshot->pieces, {0}};
    Kinks kinks = {p->now.kinks.ring, p->now.kinks.capacity, snapshot->kinks, snapshot->now.kinks.many, {0}};
    memcpy(kinks.ahead, snapshot->passed, sizeof kinks.ahead);
    for (Count k = 0; k < snapshot->pieces; k++) pass_piece(&tape, piece(&hole, k));
    for (Count k = 0; k < snapshot->kinks; k++) pass_kink(&tape, kink(&kinks, k));
    d->drilled_length = snapshot->drilled_length, d->given.rss_force = (double)NAN; /* others may have led here */
    double cosine = p->now.cosine;
    p->now = snapshot->now, p->now.hole = hole, p->now.kinks = kinks, p->around = snapshot->around;
    p->around.near = p->around.known = 1; /* for all that is said */
    find_places(&p->now, &p->scaled, p->now.step.xi);
    memcpy(p->now.kinks.ahead, snapshot->passed, sizeof p->now.kinks.ahead);
    p->law_known = p->exit_known = p->under_way = 0;
    if (p->now.cosine != cosine) take_cosine(d, p->now.cosine);
    bear(p, p->now.inputs.W);
    forget_seen(p);
    clear(p);
}

/* Go back to a state that this run has saved itself. */
static inline void drilling_return(Drilling *d, const double *state) {
    Tape tape = {NULL, state, 0, LLONG_MAX, 1};
    Snapshot snapshot = {0};
    pass_snapshot(&tape, &d->integrator.scaled, &snapshot);
    become(d, &snapshot, tape);
}

/* Go to a state of a run with the same system, if the numbers can be one; FULL if that needs the capacity `wanted`. */
static inline Status drilling_restore(Drilling *d, const double *state, Count count, Count *wanted, Problem *problem) {
    Tape tape = {NULL, state, 0, count, 1};
    Snapshot snapshot = {0};
    if (!read_state(d, count, &tape, &snapshot)) {
        wrong(problem, NO_STATE, Q_STATE, 0, (double)count, NAN);
        return FAILED;
    }
    *wanted = snapshot_capacity(&snapshot);
    if (d->integrator.now.hole.capacity < *wanted) return FULL;
    become(d, &snapshot, tape);
    return DONE;
}

#endif
