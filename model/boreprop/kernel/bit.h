/* The bit at the front of its hole: what evolves, what does not, and what acts on the BHA behind it. */
#ifndef BOREPROP_BIT_H
#define BOREPROP_BIT_H

#include "body.h"
#include "ground.h"

enum { INCLINATION, AZIMUTH }; /* of an axis; the second in space only */

/* The last reading of a sensor: how many there have been, and the inclination, and azimuth, that it told. */
typedef struct {
    double count, told[DIRECTIONS];
} Reading;

#define BLIND 1.0 /* ℓ₁: for how long the hole at a point of the body is not looked at, at most */

/* The inclinations of the hole behind the bit, over its reach and BLIND and somewhat beyond. */
typedef struct {
    Range before[DIRECTIONS], latest[DIRECTIONS];
    double since; /* where the latest begin */
} Inclinations;

/* Everything that evolves, but for what the rings of the hole and its kinks hold. A copy of it is a way back. */
typedef struct {
    double xi;
    ScaledInputs inputs;
    double inputs_xi; /* where they were taken over */
    Regime regime;
    double y_star[MAX_STABILIZERS]; /* clearances of the stabilizers, and … */
    double cleared;                 /* … where they got them */
    int layer;                      /* of the ground, in which the bit is, and … */
    double stay;                    /* … where it may leave it again */
    double origin[DIRECTIONS];      /* of the lateral coordinates */
    double cosine; /* of the inclination at which the weight acts along the beam; 0 if the axial load does not count */
    Step step;
    Inclinations inclinations;
    double accepted, rejected, events; /* counts of steps, of rejected trials and of bounds met */
    Reading reading[MAX_SENSORS];
    Places places; /* of the regime; from here on, each ends in a list of as many numbers as there are places */
    Hole hole;
    Kinks kinks;
} State;

/* Copy a state, of each list no more than is in use: there is a copy for each step. */
static inline void copy_state(State *to, const State *from) {
    size_t used = (size_t)from->places.count;
    memcpy(to, from, offsetof(State, places));
    memcpy(&to->places, &from->places, offsetof(Places, s) + used * sizeof *from->places.s);
    memcpy(&to->hole, &from->hole, offsetof(Hole, cursor) + used * sizeof *from->hole.cursor);
    memcpy(&to->kinks, &from->kinks, offsetof(Kinks, ahead) + used * sizeof *from->kinks.ahead);
}

/* The points of the body at the end of the last step: where they are, from the origin of the lateral coordinates, how far
   from the wall, and how much that changed along the step. Of points that are far from it, the last two are the
   clearance and −1. */
typedef struct {
    int near;  /* whether any is so near that it may have to be watched */
    int known; /* whether the distance of any is known */
    double body[DIRECTIONS][MAX_POINTS], gap[MAX_POINTS], change[MAX_POINTS];
} Surroundings;

/* Copy what is known of the first `points` of them. */
static inline void copy_around(Surroundings *to, const Surroundings *from, int points) {
    size_t size = (size_t)points * sizeof(double);
    for (int d = 0; d < DIRECTIONS; d++) memcpy(to->body[d], from->body[d], size);
    memcpy(to->gap, from->gap, size), memcpy(to->change, from->change, size);
    to->near = from->near, to->known = from->known;
}

/* Where the hole was at the points of the body, in which of its pieces, and where the bit, when it was looked at. Nothing
   but the time that a run takes depends on it. */
typedef struct {
    double Y[DIRECTIONS][MAX_POINTS], at[MAX_POINTS];
    Count cursor[MAX_POINTS];
} Seen;

/* The bit at the front of its hole, dimensionless. */
typedef struct {
    Scaled scaled;
    Modes modes;
    double length_scale, force_scale;
    Options options;
    State now;
    Surroundings around;
    Seen seen;
    Count earlier[MAX_STABILIZERS]; /* the pieces of the hole where the stabilizers were when Θ of one ℓ₁ ago was looked
                                       for; as with what is seen, nothing but time depends on it */
    Law law;                        /* of the present regime and inputs, */
    int law_known;                  /* if it is made already */
    double exit;                    /* where the bit leaves its layer of the ground in the present step, … */
    int exit_side, exit_known;      /* … on this side, if it does, and if that is known already */
    int under_way;                  /* whether a call has set out and not yet arrived; then the way back leads to … */
    State before;                   /* … the state before it, */
    Surroundings around_before;
    Kink last_kink; /* with its last kink, whose jump may have changed since */
} Integrator;

/* Note what the integrator has met at `xi`. */
static inline Status failed(const Integrator *p, Code code, double xi, Problem *problem) {
    return met(problem, code, p->options.relative_tolerance, xi * p->length_scale);
}

/* Note that the way from where the bit is takes too many steps. */
static inline Status too_many(const Integrator *p, Problem *problem) {
    return met(problem, TOO_MANY, p->options.most_steps, p->now.xi * p->length_scale);
}

/* The length of the shortest step at `xi`. */
static inline double shortest_step(const Integrator *p, double xi) {
    return p->options.smallest_step * larger(1.0, xi);
}

/* Make the law of the next step. Where it changes along the way each step has its own, made where it starts. */
APART static void renew_law(Integrator *p) {
    const State *now = &p->now;
    double xi = law_changes(&now->inputs) ? now->step.end : now->inputs_xi;
    ScaledInputs inputs = inputs_ahead(&now->inputs, xi - now->inputs_xi);
    make_law(&p->law, &p->scaled, &now->places, &p->modes, now->regime, inputs, xi);
    p->law_known = 1;
}

/* The law of the next step. */
static inline const Law *present_law(Integrator *p) {
    if (!p->law_known) renew_law(p);
    return &p->law;
}

APART static void bear_anew(Integrator *p, Axial axial) {
    load_beam(&p->modes, &p->scaled, axial);
    p->law_known = 0;
}

/* Let the beam bear the weight on the bit W. */
static inline void bear(Integrator *p, double W) {
    Axial axial = {W, p->now.cosine};
    if (axial.W != p->modes.axial.W || axial.cosine != p->modes.axial.cosine) bear_anew(p, axial);
}

/* Let the stabilizers have the clearances of the present state. */
static inline void clear(Integrator *p) {
    size_t size = (size_t)(p->scaled.n - 1) * sizeof(double);
    if (!memcmp(p->modes.y_star, p->now.y_star, size)) return;
    memcpy(p->modes.y_star, p->now.y_star, size);
    p->modes.count = p->modes.next = 0;
    p->law_known = 0;
}

/* Find the places of the present regime with the bit at `xi`; those of the stabilizers stay. */
static inline void find_places(State *now, const Scaled *scaled, double xi) {
    Places *places = &now->places;
    const Contact *contact = &now->regime.contact;
    Count oldest = first_kink(&now->kinks, scaled->n);
    places->count = place_count(*contact, scaled->n), places->nearest = INFINITY;
    for (int i = 0; i < places->count; i++) {
        places->s[i] = scaled->s[support_at(contact, scaled->n, i)];
        places->nearest = smaller(places->nearest, places->s[i]);
        if (i < scaled->n) continue;
        now->kinks.ahead[i] = kink_beyond(&now->kinks, oldest, xi + MERGE - places->s[i]);
        now->hole.cursor[i] = find(&now->hole, xi - places->s[i]);
    }
}

static inline void change_regime(Integrator *p, Regime regime) {
    p->now.regime = regime;
    p->law_known = 0;
}

/* Let points of the body have other places, with the bit at `xi`. */
static inline void change_places(Integrator *p, Contact contact, double xi) {
    p->now.regime.contact = contact;
    find_places(&p->now, &p->scaled, xi);
    p->law_known = 0;
}

/* What bends the beam with the bit in the state `x`, where the hole is `delayed` at the places. */
static inline void find_loads(
    const Integrator *p, double delayed[MAX_PLACES][DIRECTIONS], const double x[COMPONENTS], double F_rss, Loads *loads
) {
    const Places *places = &p->now.places;
    double turn = 0.0;
    loads->count = places->count, loads->F_rss = F_rss;
    for (int i = 0; i < places->count; i++) {
        loads->e[i] = x[LATERAL] - delayed[i][0] - places->s[i] * x[ANGLE];
        if (i == 0) turn = x[LATERAL] - delayed[i][0];
    }
    loads->g = sin(p->scaled.axial ? x[ANGLE] : turn);
}

/* The same with the bit at `xi`. */
static inline void find_loads_at(
    const Integrator *p, double xi, const double x[COMPONENTS], double F_rss, Loads *loads
) {
    double delayed[MAX_PLACES][DIRECTIONS];
    hole_at_places(&p->now.hole, &p->now.places, xi, delayed);
    find_loads(p, delayed, x, F_rss, loads);
}

/* The inputs with the bit at `xi`, ahead of where they were taken over. */
static inline ScaledInputs inputs_at(const State *now, double xi) {
    return inputs_ahead(&now->inputs, xi - now->inputs_xi);
}

/* The inputs where the bit is. */
static inline ScaledInputs inputs_here(const State *now) { return inputs_at(now, now->xi); }

/* The steering force with the bit at `xi`. */
static inline double force_at(const State *now, double xi) { return F_rss_at(&now->inputs, xi - now->inputs_xi); }

#endif
