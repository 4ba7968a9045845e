/* The integrator: it advances the state of a law, step by step. Only the law knows what is drilled.

   A step ends where the solution is not smooth: on a change of input, on an event (contact or saturation comes or goes),
   and where a stabilizer passes the kink that either left in the hole. The steps are the integrator's own: the bit may
   stop anywhere. */
#ifndef BOREPROP_INTEGRATOR_H
#define BOREPROP_INTEGRATOR_H

#include "sensors.h"
#ifdef SPACE
#include "space_landing.h"
#else
#include "landing.h"
#endif

/* integrator.py gives the reasons for these numbers. */
#define LOOK_BACK 1.0      /* ℓ₁: how far behind the bit Θ may be asked for */
#define SAFETY 0.85        /* of the step that the error estimate asks for, so that few of the next ones are rejected */
#define LARGEST_GROWTH 8.0 /* of a step over the last */
#define SMALLEST_GROWTH 0.1 /* of a trial over a rejected one */
#define LEAST_ERROR 1e-12   /* of a trial, over the tolerance */
#define STRETCH 1.3         /* how much longer than planned a step may be if it then ends on the next kink */
/* By this factor a step is tried shorter where each regime meets a bound before its first point, and the slack by which
   values may lie beyond their bounds at the points is made larger. */
#define CLOSER 8.0
#define MOST_SLACK 1e-6  /* of that slack */
#define ORIGIN_LIMIT 8.0 /* |Y| beyond which the origin of Y is moved to the bit */
/* In space the law of a regime goes on beyond a bound nearly as that of the regime beyond: the solution bends there. */
#define FAR 0.8   /* of its length: a trial that meets a bound so early has led far beyond it, and is tried again … */
#define CRUDE 0.3 /* … if its error, over the tolerance, is more than this: inside it is larger than at the end */
#define PAST 1.03 /* over the way to the bound: how long it is tried then */

/* Go to the regime on the other side of the bound that a step has met. */
static inline void pass_event(Integrator *p, const Step *step) {
    change_regime(p, switch_over(p->now.regime, p->scaled.n, step->event, step->side));
}

/* A step of length zero at `xi`, where the last one has led to the state `x`: for a run to start or restart there. */
static inline Step standstill(const Step *last, double xi, const double x[COMPONENTS]) {
    Step step = {.xi = xi, .h = 1.0, .end = xi, .event = NONE, .next_h = INFINITY};
    for (int c = 0; c < COMPONENTS; c++) step.x[c][0] = x[c];
    lead_on(last, xi, &step);
    return step;
}

/* Where the bit is, from the start of the run: its depth is the last of the coordinates. */
static inline void position(const State *now, double path[AXES]) {
    memcpy(path, now->step.path, sizeof now->step.path);
    move_along(&now->step, now->xi, path);
}

/* Move the origin of the lateral coordinates to the bit, where the state is `x`, if it is far. */
static inline void keep_origin_near(State *now, double x[COMPONENTS]) {
    int far = 0;
    for (int c = LATERAL; c < COMPONENTS; c++) far |= fabs(x[c]) > ORIGIN_LIMIT;
    if (!far) return;
    shift_origin(&now->hole, x);
    for (int c = LATERAL; c < COMPONENTS; c++) now->origin[c - LATERAL] += x[c], x[c] = 0.0;
}

/* Go over the end of the last step, with its event: gives the state `x` there, and returns the order of the kink that the
   hole has there. */
static inline int leave(Integrator *p, const Step *last, double x[COMPONENTS]) {
    State *now = &p->now;
    double xi = last->end;
    step_state(last, xi, x);
    double before[COMPONENTS];
    memcpy(before, x, sizeof before);
    keep_origin_near(now, x);
    move_seen(p, before, x);
    forget(&now->hole, xi - LOOK_BACK - p->scaled.s[p->scaled.n - 1]);
    move_cursors(&now->hole, &now->places, xi);
    /* a step may have to stop half way to a kink: a kink too near for that counts as met here */
    int kink = kink_here(&now->kinks, &now->places, xi, larger(MERGE, 2 * shortest_step(p, xi)));
    if (last->event != NONE) {
        pass_event(p, last);
        now->events++;
        kink = 2; /* Y' is continuous over a bound, Y'' is not */
    }
    if (p->scaled.points) choose_watched(p, xi);
    return kink;
}

/* Whether the rings have room for one step more, besides what the way back needs. */
static inline int has_room(const Integrator *p) {
    const State *now = &p->now, *oldest = p->under_way ? &p->before : now;
    Count live = now->hole.end - now->hole.first; /* a shift of the origin writes them anew */
    return now->hole.end - oldest->hole.first + live + 1 <= now->hole.capacity &&
           now->kinks.end - first_kink(&oldest->kinks, p->scaled.n) + 2 <= now->kinks.capacity;
}

/* How a step is tried, and tried again. */
typedef struct {
    double planned; /* length of the next trial if there is no kink */
    double resumed; /* the length that may follow if a kink cuts the step short */
    int repeated;   /* an earlier trial was no good: the next is never longer than planned */
    double slack;   /* by which values at its points may lie beyond a bound */
    int switches;   /* of the regime where it starts */
    int searched;   /* whether all contacts have been searched for there */
    double h;       /* the length of the trial */
    int order;      /* in h, of the error of a trial that errs too much */
} Plan;

/* The plan of the next step: as the last one left it, but after a kink no longer than `layers` allow. */
static inline Plan first_plan(Integrator *p, const Step *last, int kink) {
    Plan plan = {last->next_h, last->next_h, 0, ROUNDING, 0, 0, 0.0, S + 1};
    if (kink <= SMOOTHEST_KINK || last->end == last->xi) {
        plan.planned = smaller(plan.planned, p->options.layers * present_law(p)->relaxation);
        if (last->event != NONE) plan.resumed = plan.planned;
        if (p->now.kinks.many) plan.order = 2; /* of the transient; other runs keep their steps to the last bit */
    }
    return plan;
}

/* Choose the length of the trial: as planned, but no kink lies within it, and none is left a short step ahead. */
static inline void choose_length(const Integrator *p, const Law *law, double xi, Plan *plan) {
    double largest = smaller(smaller(p->options.largest_step, p->now.places.nearest), law->longest);
    int many = p->now.kinks.many || p->now.regime.contact.watched;
    double h = smaller(plan->planned, largest);
    double way = reach(&p->now.kinks, &p->now.places, law->gains, &p->options, many, xi, &h);
    double longest = plan->repeated ? h : smaller(STRETCH * h, largest);
    if (way < 2 * h) h = way <= longest ? way : way / 2;
    plan->h = h;
}

/* A trial step of length `h` from the state `x`, before events cut it. */
static inline void try_step(const Integrator *p, const Law *law, double h, const double x[COMPONENTS], Trial *trial) {
    const Step *last = &p->now.step;
    Step *step = &trial->step;
    step->h = h, step->end = step->xi + h, step->event = NONE, step->side = 0;
    trial->follows = p->now.stay > 0 && last->end > last->xi, trial->passes = p->now.kinks.many;
    look_up(&p->now.hole, &p->now.places, trial);
    law_try(law, &p->options, last, x, trial);
}

/* Whether the numbers of a trial step are finite. */
static inline int is_finite(const Trial *trial) {
    for (int c = 0; c < COMPONENTS; c++)
        if (!isfinite(trial->step.x[c][S])) return 0;
    return isfinite(trial->error);
}

/* How much longer than a trial with this error the next one may be: the error grows as h^order. */
static inline double growth(double error, int order) { return SAFETY * pow(larger(error, LEAST_ERROR), -1.0 / order); }

/* The length that is planned for the next step after one with this error. */
static inline double next_length(const Plan *plan, double error) {
    double least = plan->h < plan->resumed ? plan->resumed : 0.0, most = LARGEST_GROWTH * plan->h;
    return least >= most ? least : larger(least, smaller(plan->h * growth(error, S + 1), most));
}

/* The weight on the bit that a BHA bears while it is held at some contacts alone, over F*; it bears none of `most`. */
APART static double borne(const Integrator *p, const Contact *contact, double most) {
    signed char holds[MAX_SUPPORTS] = {0};
    double low = 0.0;
    int n = p->scaled.n;
    Beam beam;
    Chain chain;
    for (int i = 0; i < place_count(*contact, n); i++) holds[support_at(contact, n, i)] = contact->of[i];
    while (most - low > 1e-6 * most) {
        Axial axial = {(low + most) / 2, p->now.cosine};
        make_stepped_beam(&beam, &p->scaled, axial);
        if (make_chain(&chain, &beam, n + p->scaled.points, holds)) low = axial.W;
        else most = axial.W;
    }
    return low;
}

/* Find contacts between which the BHA stands, where it has come free at a stabilizer without which it does not. It may be
   free there if other supports hold it; if it would have to jump to the other wall, it is at its end. */
static inline Status stand(Integrator *p, double xi, const double x[COMPONENTS], Plan *plan, Problem *problem) {
    Contact before = p->now.regime.contact;
    int jumps = plan->searched;
    double bears = borne(p, &p->now.regime.contact, p->now.inputs.W);
    plan->searched = 1;
    if (touch_down(p, xi, x, 1, problem) != DONE) return FAILED;
    for (int i = 0; i < p->scaled.n - 1; i++) jumps |= !before.of[i] && p->now.regime.contact.of[i];
    return jumps ? met(problem, SNAPS, bears * p->force_scale, xi * p->length_scale) : DONE;
}

/* Whether a trial is too long: it errs too much, or in space has led far beyond a bound. Then a shorter one is planned. Else it
   ends at the first bound that it meets. A trial that is too hard has no solution, along which it could meet one. */
static inline int too_long(Integrator *p, const Law *law, Plan *plan, Trial *trial) {
    const Step *step = &trial->step;
    if (trial->error <= 1.0 || (DIRECTIONS > 1 && trial->error != TOO_HARD))
        cut_at_event(&p->now.places, &p->now.hole, law, plan->slack, trial);
    double way = step->end - step->xi;
    int far = DIRECTIONS > 1 && way >= shortest_step(p, step->xi) && way < FAR * plan->h;
    if (trial->error <= (far ? CRUDE : 1.0)) return 0;
    double shorter = plan->h * larger(growth(trial->error, plan->order), SMALLEST_GROWTH);
    plan->planned = plan->resumed = far ? PAST * way : shorter;
    plan->repeated = 1;
    p->now.rejected++;
    return 1;
}

/* Find the first trial of a step whose error is tolerable and whose regime holds beyond its start at `xi`, and its event.

   A bound that is met where the step starts switches the regime there. By the rates exactly one regime holds, but
   perhaps for a touch that is over before the first point of the step: then each regime finds itself beyond a bound
   there, and the step is tried shorter. At h → 0 the regime that holds shows. Where rounding hides it, a value may lie
   beyond its bound by a slack that grows as h falls; their product, what a wrong regime adds to the state, is the same
   each time. */
static inline Status find_step(
    Integrator *p, double xi, const double x[COMPONENTS], Plan *plan, Trial *trial, Problem *problem
) {
    const Step *step = &trial->step;
    double shortest = shortest_step(p, xi);
    for (;;) {
        const Law *law = present_law(p);
        if (!law->stands) {
            if (stand(p, xi, x, plan, problem) != DONE) return FAILED;
            continue;
        }
        choose_length(p, law, xi, plan);
        if (plan->h < shortest) { /* where other contacts hold, a regime may have no answer */
            if (!lands(p) || plan->searched) return failed(p, TOO_SHORT, xi, problem);
            plan->searched = 1, plan->switches = 0;
            if (touch_down(p, xi, x, 1, problem) != DONE) return FAILED;
            plan->planned = p->options.layers * present_law(p)->relaxation;
            continue;
        }
        try_step(p, law, plan->h, x, trial);
        if (!is_finite(trial)) return failed(p, NOT_FINITE, xi, problem);
        if (too_long(p, law, plan, trial)) continue;
        if (step->event == NONE || step->end - xi >= shortest) return DONE;
        if (plan->switches < 2 * law->bound_count) {
            pass_event(p, step);
            plan->switches++;
            continue;
        }
        if (lands(p) && !plan->searched) {
            plan->searched = 1, plan->switches = 0;
            if (touch_down(p, xi, x, 1, problem) == DONE) continue;
        }
        plan->planned = larger(plan->h / CLOSER, shortest);
        plan->repeated = 1, plan->switches = 0, plan->slack *= CLOSER;
        if (plan->slack >= MOST_SLACK) return failed(p, NO_MODE, xi, problem);
    }
}

/* See that no point of the body that is not watched has come through the wall along a trial step: where one has, it is
   watched and the step tried again, where too many have for that, over a shorter length, along which fewer do. Remember how
   far from the wall they are then. */
static inline Status keep_clear(
    Integrator *p, const Step *last, int kink, const double x[COMPONENTS], Plan *plan, Trial *trial, Problem *problem
) {
    double body[DIRECTIONS][MAX_POINTS];
    for (;;) {
        find_body_after(p, trial, body);
        look_around(p, &trial->step, body);
        int beyond = p->around.near ? watch_beyond(p, last->end) : 0; /* those beyond are near */
        if (!beyond) break;
        double shorter = plan->h / CLOSER;
        p->now.rejected++;
        forget_seen(p);
        *plan = first_plan(p, last, kink);
        if (beyond < 0) plan->planned = shorter, plan->repeated = 1;
        if (beyond < 0 && shorter < shortest_step(p, last->end))
            return met(problem, TOO_CROWDED, MAX_WATCHED, last->end * p->length_scale);
        Status status = find_step(p, last->end, x, plan, trial, problem);
        if (status != DONE) return status;
    }
    for (int d = 0; d < DIRECTIONS; d++) memcpy(p->around.body[d], body[d], (size_t)p->scaled.points * sizeof *body[d]);
    note_inclinations(&p->now.inclinations, &trial->step, p->scaled.s[p->scaled.n - 1]);
    return DONE;
}

/* Append one step at the end of the last one. */
static inline Status take_step(Integrator *p, Problem *problem) {
    State *now = &p->now;
    const Step last = now->step;
    double x[COMPONENTS], end[COMPONENTS];
    Trial trial;
    if (!has_room(p)) return FULL;
    read_sensors(p, last.end);
    int kink = leave(p, &last, x);
    if (p->law.changes) p->law_known = 0;
    Plan plan = first_plan(p, &last, kink);
    trial.step.xi = last.end;
    lead_on(&last, last.end, &trial.step);
    Status status = find_step(p, last.end, x, &plan, &trial, problem);
    if (status == DONE && p->scaled.points) status = keep_clear(p, &last, kink, x, &plan, &trial, problem);
    if (status != DONE) return status;
    Step *step = &now->step;
    *step = trial.step;
    p->exit_known = 0;
    step->next_h = next_length(&plan, trial.error);
    step_state(step, step->end, end);
    if (turns_over(present_law(p), &trial, end)) return failed(p, TURNS_OVER, step->end, problem);
    append(&now->hole, step, &now->inputs, last.end - now->inputs_xi);
    if (kink <= SMOOTHEST_KINK)
        add_kink(&now->kinks, p->scaled.n, last.end, kink, step_jump(&last, step, kink, last.end));
    now->accepted++;
    return DONE;
}

/* Go back to where a call has set out that has not arrived. */
static inline void go_back(Integrator *p) {
    if (!p->under_way) return;
    copy_state(&p->now, &p->before);
    copy_around(&p->around, &p->around_before, p->scaled.points);
    *kink(&p->now.kinks, p->now.kinks.end - 1) = p->last_kink;
    p->law_known = p->exit_known = p->under_way = 0;
    bear(p, p->now.inputs.W);
    forget_seen(p);
    clear(p);
}

/* Remember the state where a call sets out; 0 if the rings have no room. */
static inline int set_out(Integrator *p) {
    if (p->under_way) return 1;
    if (!has_room(p)) return 0;
    copy_state(&p->before, &p->now);
    copy_around(&p->around_before, &p->around, p->scaled.points);
    p->last_kink = *kink(&p->now.kinks, p->now.kinks.end - 1);
    p->under_way = 1;
    return 1;
}

/* Take steps until `xi` lies within one. */
static inline Status integrate(Integrator *p, double xi, Problem *problem) {
    double most = p->options.most_steps, last = p->before.accepted + most;
    Status status = DONE;
    if (xi > p->now.step.end && xi - p->now.xi > most * p->options.largest_step) return too_many(p, problem);
    while (status == DONE && xi > p->now.step.end)
        status = p->now.accepted < last ? take_step(p, problem) : too_many(p, problem);
    return status;
}

/* Go on in larger rings; the old ones may be freed afterwards. */
static inline void move_rings(Integrator *p, Piece *pieces, Kink *kinks, Count capacity) {
    State *now = &p->now;
    const State *oldest = p->under_way ? &p->before : now;
    Hole hole = {pieces, capacity, 0, 0, {0}};
    Kinks ahead = {kinks, capacity, 0, p->now.kinks.many, {0}};
    for (Count k = oldest->hole.first; k < now->hole.end; k++) *piece(&hole, k) = *piece(&now->hole, k);
    for (Count k = first_kink(&oldest->kinks, p->scaled.n); k < now->kinks.end; k++)
        *kink(&ahead, k) = *kink(&now->kinks, k);
    now->hole.ring = p->before.hole.ring = pieces, now->kinks.ring = p->before.kinks.ring = kinks;
    now->hole.capacity = p->before.hole.capacity = now->kinks.capacity = p->before.kinks.capacity = capacity;
}

#endif
