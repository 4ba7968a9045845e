/* The borehole propagation: the state (θ, Y) and the integrator that advances it.

   Within a mode the right-hand side (law.h) is linear but for sin⟨Θ⟩_1, so one step is one linear solve of Radau
   collocation (radau.h). A step ends where the solution is not smooth: on a change of input, on an event (contact or
   saturation comes or goes), and where a stabilizer passes the kink that either left in the hole. The steps are the
   integrator's own: the bit may stop anywhere. */
#ifndef BOREPROP_PROPAGATION_H
#define BOREPROP_PROPAGATION_H

#include "hole.h"
#include "law.h"

#define SMALLEST_STEP 1e-12
#define LARGEST_STEP 1.0 /* ℓ₁: the shortest delay, so a step never needs a hole that is not yet drilled */
#define LOOK_BACK 1.0 /* ℓ₁: how far behind the bit Θ may be asked for */
#define LARGEST_GROWTH 8.0
#define SAFETY 0.85
#define THETA_WEIGHT 0.1 /* θ forgets an error within εηΠ, Y carries it for the length of the BHA */
#define REST 0.03        /* what may be left of sin⟨Θ⟩_1 beyond its linear part, in tolerances of θ */
#define ITERATIONS 10    /* on that rest; each gains two digits or more */
#define LAYERS 16.0      /* first step after a kink, in relaxation lengths of θ */
#define STRETCH 1.3      /* how much longer than planned a step may be if it then ends on the next kink */
#define SMOOTHEST_KINK 3 /* jumps in higher derivatives of the hole are left to the error estimate */
#define LARGEST_INCLINATION 6.283185307179586
#define TURNS_OVER                                                                                                     \
    "its inclination grows beyond a full turn; use a smaller or shorter rss_force, a larger active_weight_on_bit, "    \
    "or check the parameters"
#define NEAR 0.3         /* how far beyond its values at the points of a step a value may lie between them */
#define MERGE 1e-9       /* kinks closer than this are one */
#define CLOSER 8.0       /* how much shorter a step is tried where each mode meets a bound before its first point, */
#define MOST_SLACK 1e-6  /* while a value may lie so much farther beyond its bound at the points, at last by this */
#define ORIGIN_LIMIT 8.0 /* |Y| beyond which the origin of Y is moved to the bit */

enum { NONE = -1, SMOOTH = 100 }; /* no event; no kink: of an order higher than any */

/* A stretch [xi, end] of the run: the state as polynomials in t = (ξ − xi)/h, and why it ends. */
typedef struct {
    double xi, h, theta[S + 1], Y[S + 1], end;
    int event, side; /* the part whose bound is met at the end, and on which side */
    double next_h;
} Step;

/* Everything that evolves, but for what the rings of the hole hold: a copy of it is the way back. */
typedef struct {
    double xi;
    ScaledInputs inputs;
    double inputs_xi; /* where they were taken over */
    Contact contact;
    int tilt;
    double path[2]; /* ∫ sin Θ dξ, ∫ cos Θ dξ up to the start of the present step */
    double origin;  /* of Y */
    Step step;
    Pieces pieces;
    Count kinks_end, ahead[MAX_STABILIZERS]; /* the next kink that each stabilizer will pass */
    double accepted, rejected, events;       /* steps, steps, bounds met */
} State;

/* The bit at the front of its hole, dimensionless: `drill` moves it, the rest looks. */
typedef struct {
    Scaled scaled;
    Modes modes;
    Radau radau;
    double length_scale, tolerance;
    Hole hole;
    State now;
    Law law;       /* of the present contact, tilt and inputs, */
    int law_known; /* once it has been asked for */
    int under_way; /* from `before`, and what the way back there needs: */
    State before;
    Kink last_kink;
    Count oldest_piece, oldest_kink;
} Propagation;

/* A step as the collocation gives it, before events cut it, with values at the points. */
typedef struct {
    Step step;
    double thetas[POINTS], Ys[POINTS], delayed[MAX_STABILIZERS][POINTS], sines[POINTS], ahead[POINTS];
    double error; /* estimated, over the tolerance */
} Trial;

/* (θ, Y) at `xi`. */
static inline void step_state(const Step *step, double xi, double *theta, double *Y) {
    double t = (xi - step->xi) / step->h;
    *theta = polynomial(step->theta, t), *Y = polynomial(step->Y, t);
}

/* A derivative of Y at `xi`. */
static inline double step_derivative(const Step *step, int order, double xi) {
    double t = (xi - step->xi) / step->h, value = 0.0;
    for (int m = S; m >= order; m--) {
        double factor = 1.0;
        for (int k = 0; k < order; k++) factor *= m - k;
        value = value * t + factor * step->Y[m];
    }
    return value / pow(step->h, order);
}

/* ∫ sin Θ dξ and ∫ cos Θ dξ up to `xi`: to the start of the step, and on by Gauss's three points. */
static inline void position_at(const State *now, double xi, double *x, double *z) {
    const Step *step = &now->step;
    double nodes[3] = {0.5 - sqrt(0.15), 0.5, 0.5 + sqrt(0.15)}, weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double length = xi - step->xi, sideways = 0.0, down = 0.0;
    for (int k = 0; k < 3; k++) {
        double Theta = polynomial_slope(step->Y, nodes[k] * length / step->h) / step->h;
        sideways += weights[k] * sin(Theta), down += weights[k] * cos(Theta);
    }
    *x = now->path[0] + sideways * length, *z = now->path[1] + down * length;
}

/* looking */

/* The force where the bit is. */
static inline double present_force(const State *now) {
    return now->inputs.F_rss + now->inputs.F_rss_slope * (now->xi - now->inputs_xi);
}

/* What bends the beam with the bit at `xi`. */
static inline Loads loads_at(const Propagation *p, double xi, double theta, double Y, double F_rss) {
    double Y_1 = 0.0;
    Loads loads = {{0}, F_rss, 0};
    for (int i = 0; i < p->scaled.n; i++) {
        double Y_i = hole_Y(&p->hole, p->now.pieces, xi - p->scaled.s[i]);
        if (i == 0) Y_1 = Y_i;
        loads.e[i] = Y - Y_i - p->scaled.s[i] * theta;
    }
    loads.sin_Theta_1 = sin(Y - Y_1);
    return loads;
}

/* What bends the beam where the bit is. */
static inline Loads present_loads(const Propagation *p) {
    double theta, Y;
    step_state(&p->now.step, p->now.xi, &theta, &Y);
    return loads_at(p, p->now.xi, theta, Y, present_force(&p->now));
}

/* Θ, eq. (16): algebraic, it jumps with the inputs. */
static inline double inclination_under(Propagation *p, double theta, const Loads *loads, double eta_pi) {
    const Mode *mode = settle(&p->modes, loads, p->now.contact);
    return theta - bit_tilt(row_value(&mode->F_0, loads, p->scaled.n), eta_pi, p->scaled.psi_star);
}

/* Θ at the bit. */
static inline double inclination(Propagation *p) {
    double theta, Y;
    Loads loads = present_loads(p);
    step_state(&p->now.step, p->now.xi, &theta, &Y);
    return inclination_under(p, theta, &loads, p->now.inputs.eta_pi);
}

/* What Θ was when the bit was at `xi`, at most LOOK_BACK behind; where it jumped, after the jump. */
static inline double earlier_inclination(Propagation *p, double xi) {
    const Piece *at = piece(&p->hole, find(&p->hole, p->now.pieces, xi + MERGE));
    if (at->inputs.eta_pi == 0) return hole_Theta(&p->hole, p->now.pieces, xi);
    double ahead = larger(xi - at->start, 0.0), t = ahead * at->rate, theta = polynomial(at->theta, t);
    double F_rss = at->inputs.F_rss + at->inputs.F_rss_slope * ahead;
    Loads loads = loads_at(p, at->start + ahead, theta, polynomial(at->c, t), F_rss);
    return inclination_under(p, theta, &loads, at->inputs.eta_pi);
}

/* the integrator */

/* A step of no length where the bit is. */
static inline void stand_still(State *now, double theta, double Y) {
    Step step = {now->xi, 1.0, {theta}, {Y}, now->xi, NONE, 0, INFINITY};
    now->step = step;
}

/* Mark where the stabilizers will pass a jump in a derivative of the hole's Y at `xi`; jumps at one place add up. */
static inline void add_images(Propagation *p, double xi, int order, double jump) {
    Kink added = {xi, jump, order}, *last = kink(&p->hole, p->now.kinks_end - 1);
    if (order > SMOOTHEST_KINK) return;
    if (p->now.kinks_end > p->now.ahead[p->scaled.n - 1] && last->xi == xi && last->order == order) last->jump += jump;
    else *kink(&p->hole, p->now.kinks_end++) = added;
}

/* The line that says what the integrator has met at `xi`, and what helps. */
static inline Status failed(const Propagation *p, const char *what, double xi, const char *helps, char why[MESSAGE]) {
    char at[32];
    snprintf(why, MESSAGE, "%s at %s m: %s", what, decimal(xi * p->length_scale, 9, at), helps);
    return FAILED;
}

/* The same where another tolerance helps. */
static inline Status failed_at_tolerance(
    const Propagation *p, const char *what, double xi, const char *helps, char why[MESSAGE]
) {
    char now[32], line[128];
    snprintf(line, sizeof line, "%s relative_tolerance (--tolerance), now %s", helps, decimal(p->tolerance, 6, now));
    return failed(p, what, xi, line, why);
}

/* The line that says that numbers have run away. */
static inline Status not_finite(const Propagation *p, double xi, char why[MESSAGE]) {
    return failed(p, "the state is not finite", xi, "check inputs and parameters", why);
}

/* The shortest step at `xi`: the next position must differ. */
static inline double shortest_step(double xi) { return SMALLEST_STEP * larger(1.0, xi); }

/* Find the mode under new inputs and mark the jump of the inclination, which was Θ, that they make. */
static inline Status restart(Propagation *p, double Theta, char why[MESSAGE]) {
    State *now = &p->now;
    Loads loads = present_loads(p);
    const Mode *mode = settle(&p->modes, &loads, now->contact);
    double F_0 = row_value(&mode->F_0, &loads, p->scaled.n), psi_star = p->scaled.psi_star;
    double jump = fabs(now->step.theta[0] - bit_tilt(F_0, now->inputs.eta_pi, psi_star) - Theta);
    if (!isfinite(jump) || !isfinite(F_0)) return not_finite(p, now->xi, why);
    p->law_known = 0;
    now->contact = mode->contact;
    now->tilt = left(F_0 / now->inputs.eta_pi, -psi_star, psi_star, ROUNDING);
    add_images(p, now->xi, 1, jump);
    return DONE;
}

static inline const Law *present_law(Propagation *p) {
    if (!p->law_known) {
        const Mode *mode = mode_of(&p->modes, p->now.contact);
        p->law = make_law(&p->scaled, &p->modes, mode, p->now.tilt, p->now.inputs);
        p->law_known = 1;
    }
    return &p->law;
}

/* Go to the mode on the other side of a bound. */
static inline void switch_over(Propagation *p, int part, int side) {
    State *now = &p->now;
    if (part < p->scaled.n - 1) now->contact.of[part] = change(now->contact.of[part], side);
    else now->tilt = now->tilt ? 0 : side;
    p->law_known = 0;
}

/* Take the kinks up to `xi` off the lists; the lowest derivative of Y that those at `xi` make jump. */
static inline int kink_here(Propagation *p, double xi) {
    int lowest = SMOOTH;
    double near = larger(MERGE, 2 * shortest_step(xi)); /* half the way to a kink is no shorter than a step may be */
    for (int i = 0; i < p->scaled.n; i++)
        for (Count *k = &p->now.ahead[i]; *k < p->now.kinks_end; ++*k) {
            const Kink *next = kink(&p->hole, *k);
            double at = next->xi + p->scaled.s[i];
            if (at - xi > near) break;
            if (xi - at <= near && next->order + 1 < lowest) lowest = (int)next->order + 1;
        }
    return lowest;
}

/* Where the next kink lies over which a step of length `h` must not pass; it may pass over slighter ones. */
static inline double next_kink(const Propagation *p, const Law *law, double xi, double h) {
    double first = INFINITY, factorial[] = {1, 1, 2, 6, 24}, power[] = {1, h, h * h, h * h * h, h * h * h * h};
    for (int i = 0; i < p->scaled.n; i++)
        for (Count k = p->now.ahead[i]; k < p->now.kinks_end; k++) {
            const Kink *next = kink(&p->hole, k);
            double at = next->xi + p->scaled.s[i];
            int order = (int)next->order + 1;
            if (at >= xi + h || at >= first) break;
            if (law->gains[i] * next->jump * power[order] > p->tolerance * factorial[order]) first = at;
        }
    return first;
}

/* Draw the consequences of how the last step ended: θ and Y there, and the order of a kink of Y. */
static inline int leave(Propagation *p, const Step *last, double *theta, double *Y) {
    State *now = &p->now;
    position_at(now, last->end, &now->path[0], &now->path[1]);
    step_state(last, last->end, theta, Y);
    if (fabs(*Y) > ORIGIN_LIMIT) {
        shift(&p->hole, &now->pieces, *Y);
        now->origin += *Y;
        *Y = 0.0;
    }
    now->pieces.first = find(&p->hole, now->pieces, last->end - LOOK_BACK - p->scaled.s[p->scaled.n - 1]);
    int kink = kink_here(p, last->end);
    if (last->event != NONE) {
        switch_over(p, last->event, last->side);
        now->events++;
        kink = 2;
    }
    return kink;
}

/* Collocation from (θ, Y) at `xi` over `h` in one mode. */
static inline void try_step(
    const Propagation *p, const Law *law, double xi, double h, double theta, double Y, Trial *trial
) {
    const Linear *rate = &law->theta_rate, *Theta = &law->Theta;
    double(*delayed)[POINTS] = trial->delayed;
    double *Ys = trial->Ys, *sines = trial->sines, *ahead = trial->ahead;
    double held[POINTS], f_theta[POINTS], f_Y[POINTS], parts_theta[S], parts_Y[S];
    int n = p->scaled.n;
    for (int i = 0; i < n; i++) look_up(&p->hole, p->now.pieces, xi - p->scaled.s[i], h, delayed[i]);
    for (int k = 0; k < POINTS; k++) ahead[k] = xi - p->now.inputs_xi + POINT[k] * h;
    /* sin⟨Θ⟩_1 about a value near its start, ⟨Θ⟩_1 = Y(ξ) − Y(ξ−1); its part with Y belongs to the Jacobian */
    double near = Y - delayed[0][0], sine = sin(near), cosine = cos(near);
    Jacobian J = {rate->theta, rate->Y + rate->g * cosine, Theta->theta, Theta->Y + Theta->g * cosine};
    for (int k = 0; k < POINTS; k++) held[k] = sine + cosine * (Y - delayed[0][k] - near);
    double allowed = REST * p->tolerance * (fabs(rate->theta) + 1 / h);
    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        linear_held(rate, n, theta, Y, delayed, held, ahead, f_theta);
        linear_held(Theta, n, theta, Y, delayed, held, ahead, f_Y);
        collocate(&p->radau, h, J, f_theta, f_Y, parts_theta, parts_Y);
        step_values(&p->radau, Y, parts_Y, Ys);
        double far = 0.0, largest = 0.0;
        for (int k = 0; k < POINTS; k++) {
            double average = Ys[k] - delayed[0][k];
            sines[k] = sine + cosine * (average - near);
            far = larger(far, fabs(average - near));
        }
        if (far * far / 2 * fabs(rate->g) <= allowed) break; /* |sin(a + d) − sin a − d cos a| <= d²/2 */
        for (int k = 0; k < POINTS; k++) {
            double assumed = held[k] + cosine * (Ys[k] - Y);
            sines[k] = sin(Ys[k] - delayed[0][k]);
            held[k] += sines[k] - assumed;
            largest = larger(largest, fabs(sines[k] - assumed));
        }
        if (largest * fabs(rate->g) <= allowed) break;
    }
    step_values(&p->radau, theta, parts_theta, trial->thetas);
    double moved_theta = trial->thetas[AT_CHECK] - theta, moved_Y = Ys[AT_CHECK] - Y, error_theta, error_Y;
    step_error(
        h, J,
        step_slope(&p->radau, parts_theta) -
            h * (f_theta[AT_CHECK] + J.theta_theta * moved_theta + J.theta_Y * moved_Y),
        step_slope(&p->radau, parts_Y) - h * (f_Y[AT_CHECK] + J.Y_theta * moved_theta + J.Y_Y * moved_Y),
        &error_theta, &error_Y
    );
    Step step = {xi, h, {0}, {0}, xi + h, NONE, 0, INFINITY};
    step_coefficients(&p->radau, theta, parts_theta, step.theta);
    step_coefficients(&p->radau, Y, parts_Y, step.Y);
    trial->step = step;
    trial->error = larger(THETA_WEIGHT * fabs(error_theta), fabs(error_Y)) / p->tolerance;
}

/* Value of a bound at `xi` in a step. */
static inline double bound_value(const Propagation *p, const Bound *bound, const Step *step, double xi) {
    double theta, Y, delayed[MAX_STABILIZERS] = {0};
    step_state(step, xi, &theta, &Y);
    for (int i = 0; i < p->scaled.n; i++) delayed[i] = hole_Y(&p->hole, p->now.pieces, xi - p->scaled.s[i]);
    double ahead = xi - p->now.inputs_xi;
    return linear_at(&bound->value, p->scaled.n, theta, Y, delayed, sin(Y - delayed[0]), ahead);
}

/* Where a bound is passed on `side` in [a, b], its value at `b` being f_b beyond: by regula falsi with the weights of
   Anderson and Björck. */
static inline double crossing(
    const Propagation *p, const Bound *bound, const Step *step, int side, double a, double b, double f_b
) {
    double limit = side > 0 ? bound->upper : bound->lower;
    double f_a = side * (bound_value(p, bound, step, a) - limit), c = b;
    if (f_a >= 0) return a;
    for (int k = 0; k < 60; k++) {
        c = (a * f_b - b * f_a) / (f_b - f_a);
        double f_c = side * (bound_value(p, bound, step, c) - limit);
        if (fabs(f_c) < ROUNDING / 10 || fabs(b - a) < SMALLEST_STEP) break;
        if ((f_c > 0) == (f_b > 0)) {
            double weight = 1 - f_c / f_b;
            f_a *= weight > 0 ? weight : 0.5;
        } else a = b, f_a = f_b;
        b = c, f_b = f_c;
    }
    return c;
}

typedef struct {
    double xi, value;
} Sample;

/* Where a smooth function through samples in order has extremes, by a parabola through each three; returns how many. */
static inline int extremes(const Sample *samples, int count, double *found) {
    int number = 0;
    for (int k = 0; k + 2 < count; k++) {
        Sample a = samples[k], b = samples[k + 1], c = samples[k + 2];
        double slope = (b.value - a.value) / (b.xi - a.xi), later = (c.value - b.value) / (c.xi - b.xi);
        if (slope * later <= 0 && slope != later)
            found[number++] = (a.xi + b.xi) / 2 - slope * (c.xi - a.xi) / 2 / (later - slope);
    }
    return number;
}

/* Where a step first meets one bound, given its values at the points; on which side, 0 if it does not. */
static inline int meet(
    const Propagation *p, const Bound *bound, double slack, const Step *step, const double *values, double *where
) {
    Sample known[2 * POINTS];
    double found[POINTS];
    int count = POINTS + 1;
    known[0].xi = step->xi, known[0].value = bound_value(p, bound, step, step->xi);
    for (int k = 0; k < POINTS; k++) known[k + 1].xi = step->xi + POINT[k] * step->h, known[k + 1].value = values[k];
    int number = extremes(known, count, found);
    for (int k = 0; k < number; k++) { /* it may leave and come back between two points */
        int place = count;
        if (!(found[k] > known[1].xi)) continue;
        for (; known[place - 1].xi > found[k]; place--) known[place] = known[place - 1];
        known[place].xi = found[k], known[place].value = bound_value(p, bound, step, found[k]);
        count++;
    }
    for (int k = 1; k < count; k++) { /* by rounding the start may lie beyond the bound that it has just come from */
        int side = left(known[k].value, bound->lower, bound->upper, slack);
        double limit = side > 0 ? bound->upper : bound->lower;
        if (!side) continue;
        *where = crossing(p, bound, step, side, known[k - 1].xi, known[k].xi, side * (known[k].value - limit));
        return side;
    }
    return 0;
}

/* End a trial step where it first meets a bound of its mode, if its points lie beyond one by more than `slack`. */
static inline void cut_at_event(const Propagation *p, const Law *law, double slack, Trial *trial) {
    for (int b = 0; b < law->bound_count; b++) {
        const Bound *bound = &law->bounds[b];
        double values[POINTS], low, high, where = 0.0;
        linear_along(
            &bound->value, p->scaled.n, trial->thetas, trial->Ys, trial->delayed, trial->sines, trial->ahead, values
        );
        low = high = values[0];
        for (int k = 1; k < POINTS; k++) low = smaller(low, values[k]), high = larger(high, values[k]);
        double near = NEAR * (high - low);
        if (low - near >= bound->lower && high + near <= bound->upper) continue;
        int side = meet(p, bound, slack, &trial->step, values, &where);
        if (side && where < trial->step.end) {
            trial->step.end = where;
            trial->step.event = bound->part, trial->step.side = side;
        }
    }
}

/* Whether the rings have room for one step more, besides what the way back needs. */
static inline int has_room(const Propagation *p) {
    const State *now = &p->now;
    Count live = now->pieces.end - now->pieces.first; /* a shift of the origin writes them anew */
    return now->pieces.end - p->oldest_piece + live + 1 <= p->hole.capacity &&
           now->kinks_end - p->oldest_kink + 2 <= p->hole.capacity;
}

/* Append one step at the end of the last one; `why` says what failed and what helps.

   A bound that is met where the step starts switches the mode there. By the rates exactly one mode holds, but perhaps
   for a touch that is over before the first point of the step: then each mode finds itself beyond a bound there, and
   the step is tried shorter. At h → 0 the mode that holds shows. Where rounding hides it, a value may lie beyond its
   bound by a slack that grows as h falls; their product, what a wrong mode adds to the state, is the same each time. */
static inline Status take_step(Propagation *p, char why[MESSAGE]) {
    State *now = &p->now;
    Step last = now->step;
    Trial trial;
    double xi = last.end, shortest = shortest_step(xi), theta, Y, growth, h, to_kink;
    if (!has_room(p)) return FULL;
    int kink = leave(p, &last, &theta, &Y), switches = 0;
    const Law *law = present_law(p);
    double planned = last.next_h, resumed = last.next_h, stretch = STRETCH, slack = ROUNDING;
    if (kink <= SMOOTHEST_KINK || last.end == last.xi) {
        planned = smaller(planned, LAYERS * law->relaxation);
        if (last.event != NONE) resumed = planned;
    }
    for (;;) {
        h = smaller(planned, LARGEST_STEP);
        to_kink = next_kink(p, law, xi, 2 * h) - xi;
        if (to_kink < 2 * h) h = to_kink <= smaller(stretch * h, LARGEST_STEP) ? to_kink : to_kink / 2;
        if (h < shortest)
            return failed_at_tolerance(p, "the steps of the integrator become too short", xi, "raise", why);
        try_step(p, law, xi, h, theta, Y, &trial);
        if (!isfinite(trial.error) || !isfinite(trial.step.Y[S])) return not_finite(p, xi, why);
        growth = SAFETY * pow(larger(trial.error, 1e-12), -1.0 / (S + 1));
        if (trial.error > 1.0) {
            planned = resumed = h * larger(growth, 0.1);
            stretch = 1.0;
            now->rejected++;
            continue;
        }
        cut_at_event(p, law, slack, &trial);
        if (trial.step.event == NONE || trial.step.end - xi >= shortest) break;
        if (switches < 2 * law->bound_count) {
            switch_over(p, trial.step.event, trial.step.side);
            law = present_law(p);
            switches++;
            continue;
        }
        planned = larger(h / CLOSER, shortest);
        stretch = 1.0, switches = 0, slack *= CLOSER;
        if (slack >= MOST_SLACK) return failed_at_tolerance(p, "no contact mode holds", xi, "change", why);
    }
    now->step = trial.step;
    if (h == to_kink && now->step.event == NONE) now->step.end = xi + to_kink;
    now->step.next_h = larger(h < resumed ? resumed : 0.0, h * smaller(growth, LARGEST_GROWTH));
    double turned, end_Y;
    step_state(&now->step, now->step.end, &turned, &end_Y);
    if (!(fabs(turned) <= LARGEST_INCLINATION))
        return failed(p, "the bit turns over", now->step.end, TURNS_OVER, why);
    Piece drilled = {xi, 1 / h, {0}, {0}, now->inputs};
    memcpy(drilled.c, now->step.Y, sizeof drilled.c);
    memcpy(drilled.theta, now->step.theta, sizeof drilled.theta);
    drilled.inputs.F_rss += now->inputs.F_rss_slope * (xi - now->inputs_xi);
    append(&p->hole, &now->pieces, &drilled);
    if (kink <= SMOOTHEST_KINK)
        add_images(p, xi, kink, fabs(step_derivative(&now->step, kink, xi) - step_derivative(&last, kink, xi)));
    now->accepted++;
    return DONE;
}

/* moving */

/* Take over inputs where the bit is. */
static inline Status steer(Propagation *p, ScaledInputs inputs, char why[MESSAGE]) {
    State *now = &p->now;
    double before = inclination(p), theta, Y, bend = inputs.F_rss_slope - now->inputs.F_rss_slope;
    position_at(now, now->xi, &now->path[0], &now->path[1]);
    step_state(&now->step, now->xi, &theta, &Y);
    now->inputs = inputs, now->inputs_xi = now->xi;
    stand_still(now, theta, Y);
    Status status = restart(p, before, why);
    if (status == DONE && bend != 0 && !now->tilt)
        add_images(p, now->xi, 2, fabs(bend * mode_of(&p->modes, now->contact)->F_0.rss / inputs.eta_pi));
    return status;
}

/* Go back to where the way began that is not yet at its end. */
static inline void go_back(Propagation *p) {
    if (!p->under_way) return;
    p->now = p->before;
    *kink(&p->hole, p->now.kinks_end - 1) = p->last_kink;
    p->law_known = p->under_way = 0;
}

/* Drill on to `xi` under inputs that act from where the bit is. After FULL the same call goes on in a larger memory. */
static inline Status drill(Propagation *p, double xi, ScaledInputs inputs, char why[MESSAGE]) {
    State *now = &p->now;
    int changed = inputs.F_rss != present_force(now) || inputs.F_rss_slope != now->inputs.F_rss_slope ||
                  inputs.eta_pi != now->inputs.eta_pi;
    Status status = DONE;
    if (changed || xi > now->step.end) {
        if (!p->under_way) {
            p->oldest_piece = now->pieces.first, p->oldest_kink = now->ahead[p->scaled.n - 1];
            if (!has_room(p)) return FULL;
            p->before = *now;
            p->last_kink = *kink(&p->hole, now->kinks_end - 1);
            p->under_way = 1;
        }
        if (changed) status = steer(p, inputs, why);
        while (status == DONE && xi > now->step.end) status = take_step(p, why);
        if (status == FAILED) go_back(p);
        if (status != DONE) return status;
        p->under_way = 0;
    }
    now->xi = xi;
    return DONE;
}

/* What does not evolve; before `begin`, or before a state is restored. */
static inline void prepare(
    Propagation *p, const Scaled *scaled, double length_scale, double relative_tolerance, Hole hole
) {
    memset(p, 0, sizeof *p);
    p->hole = hole;
    p->scaled = *scaled;
    p->modes.beam = make_beam(scaled);
    memcpy(p->modes.y_star, scaled->y_star, sizeof p->modes.y_star);
    p->radau = make_radau();
    p->length_scale = length_scale, p->tolerance = relative_tolerance;
}

/* Start at the end of a survey; the rings must have room for it. */
static inline Status begin(Propagation *p, const Survey *survey, ScaledInputs inputs, char why[MESSAGE]) {
    State *now = &p->now;
    double reach = LOOK_BACK + p->scaled.s[p->scaled.n - 1];
    double final_inclination = take_survey(&p->hole, survey, p->length_scale, reach, &now->pieces, &now->kinks_end);
    for (Count k = 0; k < now->pieces.end; k++)
        if (!check_finite("l_1 / distance of stations", piece(&p->hole, k)->rate, why)) return FAILED;
    now->inputs = inputs;
    stand_still(now, final_inclination, 0.0);
    return restart(p, final_inclination, why);
}

#endif
