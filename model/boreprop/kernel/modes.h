/* The two nonlinearities: stabilizers that touch the wall or not, and a bit tilt that saturates.

   With the contacts known (a mode), F follows from q̃ by elimination, so M, F_0, δ and F are linear functions of the
   hole, the RSS force and the weight. Which contacts hold is found by pivoting from the last mode. */
#ifndef BOREPROP_MODES_H
#define BOREPROP_MODES_H

#include "chain.h"

#include <stddef.h>

#define ROUNDING 1e-13 /* how far a force or deflection of order one may lie beyond its bound by rounding alone */

/* The supports that have a say, each with a contact: 1 lower wall, −1 upper wall, 0 free. The first places are those of
   the n stabilizers, the last of which has no contact; then come points of the body, in any order. */
typedef struct {
    signed char of[MAX_PLACES];
    unsigned char watched, point[MAX_WATCHED]; /* how many points; which support each is, less n */
} Contact;

static inline int same_contact(const Contact *a, const Contact *b) {
    if (a->watched != b->watched || memcmp(a->of, b->of, MAX_STABILIZERS)) return 0;
    return !a->watched || !memcmp(a, b, sizeof *a);
}

/* How many places there are, n of them of stabilizers. */
static inline int place_count(Contact contact, int n) { return n + contact.watched; }

/* The support at a place. */
static inline int support_at(const Contact *contact, int n, int place) {
    return place < n ? place : n + contact->point[place - n];
}

/* What bends the beam besides the contacts: offsets e of the bit's axis from the hole at each place, F_RSS, and the sine
   that goes with the weight. */
typedef struct {
    int count;
    double F_rss, g, e[MAX_PLACES];
} Loads;

/* A linear function of the loads: e · e_i + rss · F_RSS + g times the sine + constant. */
typedef struct {
    double rss, g, constant, e[MAX_PLACES];
} Row;

/* Value under `loads`. */
static inline double row_value(const Row *row, const Loads *loads) {
    return dot(loads->count, row->e, loads->e) + row->rss * loads->F_rss + row->g * loads->g + row->constant;
}

/* Add to a row, over so many places, a sum of factors times rows. */
static inline void add_rows(Row *row, int places, int count, const double *factors, const Row *const *rows) {
    double rss = 0.0, g = 0.0, constant = 0.0;
    for (int i = 0; i < places; i++) {
        double e = 0.0;
        for (int k = 0; k < count; k++) e += factors[k] * rows[k]->e[i];
        row->e[i] += e;
    }
    for (int k = 0; k < count; k++) {
        rss += factors[k] * rows[k]->rss, g += factors[k] * rows[k]->g;
        constant += factors[k] * rows[k]->constant;
    }
    row->rss += rss, row->g += g, row->constant += constant;
}

/* The beam with known contacts.

   In contact δ_i = −contact_i y*_i, so F_C = −K_C (q̃_C + contact_C y*_C), K_C = (K⁻¹_CC)⁻¹, and F = 0 elsewhere. */
typedef struct {
    Contact contact;
    int stands; /* it does not buckle between its contacts */
    Row F[MAX_PLACES], delta[MAX_PLACES], M, F_0;
} Mode;

/* q̃ at support i, which has this place: its deflection without contacts. */
static inline Row free_deflection(const Beam *beam, int i, int place) {
    Row q = {beam->delta_rss[i], beam->delta_g[i], -beam->delta_e[i] * beam->end, {0}};
    q.e[place] = 1.0, q.e[beam->n - 1] = beam->delta_e[i];
    return q;
}

/* What a beam in sections answers to one of the loads: where that stands in each row. */
typedef struct {
    double F[MAX_PLACES], delta[MAX_PLACES], M, F_0;
} Column;

/* How a chain lies with `v` at the end of one of its spans, or none, and what acts. `places` are those of the supports where
   it is held. */
static inline Column column_of(
    const Chain *chain, const Contact *contact, int n, const int *places, int moved, double v, Acting acting
) {
    Column column = {{0}, {0}, 0.0, 0.0};
    Held held;
    memset(held.v, 0, sizeof held.v);
    if (moved >= 0) held.v[moved + 1] = v;
    hold(chain, acting, &held);
    for (int k = 0; k < chain->spans - 1; k++) column.F[places[k]] = held.F[k];
    for (int i = 0; i < place_count(*contact, n); i++)
        if (!contact->of[i] && i != n - 1)
            column.delta[i] = place_between(chain, &held, acting, support_at(contact, n, i));
    column.M = held.M, column.F_0 = held.F_0;
    return column;
}

/* Put a column into the rows of a mode: as the factor of what `which` points to, in the row it belongs to. */
static inline void put_column(Mode *mode, const Column *column, int places, size_t which, double factor) {
    for (int i = 0; i < places; i++) {
        *(double *)(void *)((char *)&mode->F[i] + which) += factor * column->F[i];
        *(double *)(void *)((char *)&mode->delta[i] + which) += factor * column->delta[i];
    }
    *(double *)(void *)((char *)&mode->M + which) += factor * column->M;
    *(double *)(void *)((char *)&mode->F_0 + which) += factor * column->F_0;
}

/* The mode of a beam in sections: what each load alone does to it, held where it touches. */
static inline void make_chained_mode(Mode *mode, const Beam *beam, const double *y_star, Contact contact) {
    int n = beam->n, places = place_count(contact, n), supports = n, at[MAX_SUPPORTS], ends[MAX_PLACES + 1];
    signed char holds[MAX_SUPPORTS] = {0};
    Acting nothing = {0.0, 0.0}, weight = {1.0, 0.0}, pads = {0.0, 1.0};
    Row zero = {0, 0, 0, {0}};
    Chain chain;
    mode->contact = contact, mode->M = mode->F_0 = zero;
    for (int i = 0; i < places; i++) {
        int support = support_at(&contact, n, i);
        if (support >= supports) supports = support + 1;
        holds[support] = contact.of[i], at[support] = i;
        mode->F[i] = mode->delta[i] = zero;
    }
    mode->stands = make_chain(&chain, beam, supports, holds);
    if (!mode->stands) return;
    for (int k = 0; k < chain.spans; k++) ends[k] = at[chain.held[k]];
    for (int k = 0; k < chain.spans; k++) {
        int i = ends[k];
        Column column = column_of(&chain, &contact, n, ends, k, -1.0, nothing); /* v = −(e + contact y*), and δ_n */
        put_column(mode, &column, places, offsetof(Row, e) + (size_t)i * sizeof(double), 1.0);
        double given = i == n - 1 ? -beam->end : contact.of[i] * y_star[chain.held[k]];
        put_column(mode, &column, places, offsetof(Row, constant), given);
    }
    Column column = column_of(&chain, &contact, n, ends, -1, 0.0, weight);
    put_column(mode, &column, places, offsetof(Row, g), 1.0);
    column = column_of(&chain, &contact, n, ends, -1, 0.0, pads);
    put_column(mode, &column, places, offsetof(Row, rss), 1.0);
    for (int i = 0; i < places; i++) {
        if (i == n - 1) continue;
        if (contact.of[i]) mode->delta[i].constant = -contact.of[i] * y_star[support_at(&contact, n, i)];
        else mode->delta[i].e[i] += 1.0;
    }
}

static inline void make_mode(Mode *mode, const Beam *beam, const double *y_star, Contact contact) {
    int n = beam->n, places = place_count(contact, n), C[MAX_PLACES], support[MAX_PLACES], touching = 0;
    double K_inv_CC[SIZE][SIZE], K_C[SIZE][SIZE], factors[MAX_PLACES];
    Row to_wall[MAX_PLACES], zero = {0, 0, 0, {0}};
    const Row *rows[MAX_PLACES], *F[MAX_PLACES];
    if (beam->stepped) {
        make_chained_mode(mode, beam, y_star, contact);
        return;
    }
    mode->contact = contact, mode->stands = 1;
    for (int i = 0; i < places; i++) {
        support[i] = support_at(&contact, n, i);
        mode->F[i] = zero;
        if (i == n - 1) continue;
        mode->delta[i] = free_deflection(beam, support[i], i);
        if (contact.of[i]) C[touching++] = i;
    }
    for (int k = 0; k < touching; k++) {
        for (int l = 0; l < touching; l++) K_inv_CC[k][l] = compliance(beam, support[C[k]], support[C[l]]);
        to_wall[k] = mode->delta[C[k]];
        to_wall[k].constant += contact.of[C[k]] * y_star[support[C[k]]];
        rows[k] = &to_wall[k], F[k] = &mode->F[C[k]];
    }
    inverse(touching, (const double (*)[SIZE])K_inv_CC, K_C);
    for (int k = 0; k < touching; k++) {
        for (int l = 0; l < touching; l++) K_C[k][l] = -K_C[k][l];
        add_rows(&mode->F[C[k]], places, touching, K_C[k], rows);
    }
    for (int i = 0; i < places; i++) {
        if (i == n - 1) continue;
        for (int k = 0; k < touching; k++) factors[k] = compliance(beam, support[i], support[C[k]]);
        add_rows(&mode->delta[i], places, touching, factors, F);
    }
    mode->M = mode->F_0 = zero;
    mode->M.constant = -beam->M_e * beam->end, mode->F_0.constant = -beam->F0_e * beam->end;
    mode->M.e[n - 1] = beam->M_e, mode->M.rss = beam->M_rss, mode->M.g = beam->M_g;
    mode->F_0.e[n - 1] = beam->F0_e, mode->F_0.rss = beam->F0_rss, mode->F_0.g = beam->F0_g;
    for (int k = 0; k < touching; k++) factors[k] = beam->M_F[support[C[k]]];
    add_rows(&mode->M, places, touching, factors, F);
    for (int k = 0; k < touching; k++) factors[k] = beam->F0_F[support[C[k]]];
    add_rows(&mode->F_0, places, touching, factors, F);
}

enum { MODES = 4 }; /* that are kept: a few take turns where a hole ripples */

/* The modes of one beam that were asked for last, the very last one among them. */
typedef struct {
    Beam beam;
    Axial axial; /* under which it is */
    double y_star[MAX_SUPPORTS];
    Mode made[MODES];
    int count, next, last;
} Modes;

/* Find what acts on the beam of a mode under `loads`. */
static inline void find_bending(const Mode *mode, const Loads *loads, const Scaled *scaled, Bending *bending) {
    int n = scaled->n;
    memset(bending->F, 0, (size_t)(n + scaled->points) * sizeof *bending->F);
    bending->F_rss = loads->F_rss, bending->g = loads->g;
    bending->M = row_value(&mode->M, loads), bending->F_0 = row_value(&mode->F_0, loads);
    for (int i = 0; i < loads->count; i++)
        if (mode->contact.of[i]) bending->F[support_at(&mode->contact, n, i)] = row_value(&mode->F[i], loads);
}

/* Make the beam as it is under an axial load; no mode is known then. */
static inline void load_beam(Modes *modes, const Scaled *scaled, Axial axial) {
    make_beam(&modes->beam, scaled, axial);
    modes->axial = axial;
    modes->count = modes->next = 0;
}

static inline const Mode *mode_of(Modes *modes, const Contact *contact) {
    if (modes->count && same_contact(&modes->made[modes->last].contact, contact)) return &modes->made[modes->last];
    for (modes->last = 0; modes->last < modes->count; modes->last++)
        if (same_contact(&modes->made[modes->last].contact, contact)) return &modes->made[modes->last];
    modes->last = modes->next;
    make_mode(&modes->made[modes->last], &modes->beam, modes->y_star, *contact);
    modes->next = (modes->next + 1) % MODES;
    if (modes->count < MODES) modes->count++;
    return &modes->made[modes->last];
}

/* 1 if `value` is above its bounds by more than `slack`, −1 if below, else 0. */
static inline int side_beyond(double value, double lower, double upper, double slack) {
    return value > upper + slack ? 1 : value < lower - slack ? -1 : 0;
}

/* The contact beyond a bound on `side`: a touching stabilizer comes free, a free one touches at δ = ±y*. */
static inline signed char change(int contact, int side) { return (signed char)(contact ? 0 : -side); }

/* The wall that bears a stabilizer with the force F: 1 the lower, −1 the upper, 0 none. */
static inline int wall(double F) { return F > 0 ? 1 : F < 0 ? -1 : 0; }

/* The row that lies between two bounds while the support at place `i` stays as it is in `mode`: F_i in contact, else δ_i, (7).

   A stabilizer without clearance is held on both sides: its bounds are infinite, and while it counts as free it lies beyond
   them. */
static inline const Row *contact_bounds(const Modes *modes, const Mode *mode, int i, double *lower, double *upper) {
    int contact = mode->contact.of[i];
    double y_star = modes->y_star[support_at(&mode->contact, modes->beam.n, i)];
    if (y_star == 0.0) {
        *lower = contact ? -INFINITY : INFINITY, *upper = INFINITY;
        return &mode->F[i];
    }
    if (contact) {
        *lower = contact > 0 ? 0.0 : -INFINITY, *upper = contact > 0 ? INFINITY : 0.0;
        return &mode->F[i];
    }
    *lower = -y_star, *upper = y_star;
    return &mode->delta[i];
}

#define MOST_PIVOTS 243 /* contacts at five stabilizers: a search that takes more pivots goes in circles */
#define LOOSER 8.0      /* factor on the slack for the next search: about a digit */

/* The mode that satisfies (7) under `loads`, starting the search from some contacts.

   Least-index pivoting: switch the first stabilizer that is beyond its bounds, until none is. K is positive definite, so
   no set of contacts comes back and the search ends (Murty 1974; Júdice & Pires 1992 for two walls). Where one does
   come back, by rounding under huge loads or of stabilizers close together, stabilizers may lie beyond their bounds by
   more and more until a mode is within them: at last by any amount. */
static inline const Mode *settle(Modes *modes, const Loads *loads, const Contact *start) {
    Contact contact;
    int n = modes->beam.n;
    double slack = ROUNDING;
    for (int pivots = 1;; pivots++) {
        int side = 0;
        const Mode *mode = mode_of(modes, start);
        for (int i = 0; i < loads->count; i++) {
            double lower, upper;
            if (i == n - 1) continue;
            const Row *row = contact_bounds(modes, mode, i, &lower, &upper);
            side = side_beyond(row_value(row, loads), lower, upper, slack);
            if (!side) continue;
            contact = *start, start = &contact;
            contact.of[i] = change(contact.of[i], side);
            break;
        }
        if (!side) return mode;
        if (pivots % MOST_PIVOTS == 0) slack *= LOOSER;
    }
}

/* ψ = clip(F_0/(ηΠ), −ψ*, ψ*), eqs. (10) and (11). */
static inline double bit_tilt(double F_0, double eta_pi, double psi_star) {
    return smaller(larger(F_0 / eta_pi, -psi_star), psi_star);
}

/* The contacts, and the saturation of the bit tilt: 1 at ψ*, −1 at −ψ*, 0 between. A regime is left by a switch of one
   part: of the support at that place, or of the tilt, which has the place of the last stabilizer, n − 1. */
typedef struct {
    Contact contact;
    int saturation;
} Regime;

/* The bounds of F_0/(ηΠ) within which the saturation stays as it is. */
static inline void saturation_bounds(int saturation, double psi_star, double *lower, double *upper) {
    *lower = saturation > 0 ? psi_star : saturation < 0 ? -INFINITY : -psi_star;
    *upper = saturation > 0 ? INFINITY : saturation < 0 ? -psi_star : psi_star;
}

/* The regime beyond the bound of `part` on `side`. */
static inline Regime switch_over(Regime regime, int n, int part, int side) {
    if (part != n - 1) regime.contact.of[part] = change(regime.contact.of[part], side);
    else regime.saturation = regime.saturation ? 0 : side;
    return regime;
}

#endif
