/* The frame that goes with the bit through space, without twist: Q = [e₂ e₃ d] with d the axis of the bit, and

       e₂' = −d θ₂' ,   e₃' = −d θ₃' ,   d' = e₂ θ₂' + e₃ θ₃' .

   At the start e₂ points to where the inclination grows, e₃ = d × e₂ to the right of it, looking down the hole. */
#ifndef BOREPROP_FRAME_H
#define BOREPROP_FRAME_H

#include "numbers.h"
#include "radau_tables.h"

enum { NORTH, EAST, DOWN };  /* axes of the rock, with a row of the frame each */
enum { HIGH, RIGHT, AHEAD }; /* of the vectors e₂, e₃ and d: columns of the frame */

typedef struct {
    double row[3][3];
} Frame;

enum { MOST_TERMS = 48 };
#define LEAST_TERM 1e-16 /* of a series whose sum is of order one */

/* A row of the frame along a step, as a power series in t. */
typedef struct {
    int count;
    double term[MOST_TERMS][3];
} Series;

/* The series of a row that begins with `start`, where θ is a polynomial: (m+1) r_{m+1} = Σ_j r_{m−j} Ω_j, Ω' = Q⁻¹ Q'. It
   ends where S terms, which make the next ones, make them smaller than the least. It converges for any turn, but is given up,
   with 0, where that would take too many terms. */
static inline int make_series(const double theta[][S + 1], const double start[3], Series *series) {
    double rate[S][2], turn = 0.0;
    int small = 0;
    for (int j = 0; j < S; j++)
        for (int d = 0; d < 2; d++) rate[j][d] = (j + 1) * theta[d][j + 1], turn += fabs(rate[j][d]);
    memcpy(series->term[0], start, sizeof series->term[0]);
    for (int m = 0; m < MOST_TERMS - 1; m++) {
        double aside[2] = {0.0, 0.0}, along[2] = {0.0, 0.0}, share = 1.0 / (m + 1);
        for (int j = m < S ? m : S - 1; j >= 0; j--) { /* what was found last comes last */
            const double *r = series->term[m - j];
            for (int d = 0; d < 2; d++) aside[d] -= r[AHEAD] * rate[j][d], along[d] += r[d] * rate[j][d];
        }
        double *next = series->term[m + 1];
        for (int d = 0; d < 2; d++) next[d] = share * aside[d];
        next[AHEAD] = share * (along[0] + along[1]);
        double size = fabs(next[HIGH]) + fabs(next[RIGHT]) + fabs(next[AHEAD]);
        small = size * turn <= LEAST_TERM * (m + 1) ? small + 1 : 0;
        if (small == S) {
            series->count = m + 2;
            return 1;
        }
    }
    series->count = MOST_TERMS;
    return 0;
}

static inline void series_at(const Series *series, double t, double row[3]) {
    double high = 0.0, right = 0.0, ahead = 0.0;
    for (int m = series->count - 1; m >= 0; m--) {
        const double *r = series->term[m];
        high = high * t + r[HIGH], right = right * t + r[RIGHT], ahead = ahead * t + r[AHEAD];
    }
    row[HIGH] = high, row[RIGHT] = right, row[AHEAD] = ahead;
}

/* The row at the points of a step. */
static inline void series_at_points(const Series *series, double row[3][POINTS]) {
    for (int d = 0; d < 3; d++) {
        double sum[POINTS] = {0.0};
        for (int m = series->count - 1; m >= 0; m--)
            for (int k = 0; k < POINTS; k++) sum[k] = sum[k] * POINT[k] + series->term[m][d];
        memcpy(row[d], sum, sizeof sum);
    }
}

static inline double dot_3(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Make a frame orthonormal that has lost a few digits, from its rows north and down. */
static inline void straighten(Frame *frame) {
    double *north = frame->row[NORTH], *east = frame->row[EAST], *down = frame->row[DOWN];
    double share = 1 / sqrt(dot_3(down, down)), along;
    for (int k = 0; k < 3; k++) down[k] *= share;
    along = dot_3(north, down);
    for (int k = 0; k < 3; k++) north[k] -= along * down[k];
    share = 1 / sqrt(dot_3(north, north));
    for (int k = 0; k < 3; k++) north[k] *= share;
    for (int k = 0; k < 3; k++)
        east[k] = down[(k + 1) % 3] * north[(k + 2) % 3] - down[(k + 2) % 3] * north[(k + 1) % 3];
}

/* How the frame turns along a way: its rows down and, if that is asked for, north. */
typedef struct {
    int north;
    Series of_down, of_north;
} Turning;

/* On a way along which θ is a polynomial, from the frame at its start; returns 0 if it turns too far. */
static inline int make_turning(const Frame *start, const double theta[][S + 1], int north, Turning *turning) {
    turning->north = north;
    int whole = make_series(theta, start->row[DOWN], &turning->of_down);
    return (!north || make_series(theta, start->row[NORTH], &turning->of_north)) && whole;
}

/* The frame at t, where its row north is asked for. */
static inline Frame frame_at(const Turning *turning, double t) {
    Frame frame;
    series_at(&turning->of_down, t, frame.row[DOWN]), series_at(&turning->of_north, t, frame.row[NORTH]);
    straighten(&frame);
    return frame;
}

/* The frame at t on a way along which θ is a polynomial, from the frame at its start. */
static inline Frame turned_along(const Frame *start, const double theta[][S + 1], double t) {
    Turning turning;
    make_turning(start, theta, 1, &turning);
    return frame_at(&turning, t);
}

/* sin a / a and (1 − cos a)/a², which turn the frame by an angle a. */
static inline void turn_factors(double square, double *sine, double *cosine) {
    double s = square, a;
    if (square < 0.1) {
        *sine = 1 - s * (1.0 / 6) *
                        (1 - s * (1.0 / 20) * (1 - s * (1.0 / 42) * (1 - s * (1.0 / 72) * (1 - s * (1.0 / 110)))));
        *cosine = 0.5 - s * (1.0 / 24) *
                            (1 - s * (1.0 / 30) * (1 - s * (1.0 / 56) * (1 - s * (1.0 / 90) * (1 - s * (1.0 / 132)))));
    } else a = sqrt(square), *sine = sin(a) / a, *cosine = (1 - cos(a)) / square;
}

/* A row of Q R(a), where R(a) takes d towards e₂ a₂ + e₃ a₃ by the angle |a|. */
static inline void turned_row(const double row[3], const double a[2], double turned[3]) {
    double sine, cosine, square = a[0] * a[0] + a[1] * a[1], along = row[HIGH] * a[0] + row[RIGHT] * a[1];
    turn_factors(square, &sine, &cosine);
    for (int d = 0; d < 2; d++) turned[d] = row[d] - a[d] * (cosine * along + sine * row[AHEAD]);
    turned[AHEAD] = row[AHEAD] * (1 - cosine * square) + sine * along;
}

static inline Frame turn_frame(const Frame *frame, const double a[2]) {
    Frame turned;
    for (int axis = NORTH; axis <= DOWN; axis++) turned_row(frame->row[axis], a, turned.row[axis]);
    straighten(&turned);
    return turned;
}

/* The angle a by which R(a) turns d of the frame to a direction given by axis. */
static inline void turn_towards(const Frame *frame, const double direction[3], double a[2]) {
    double seen[3];
    for (int k = 0; k < 3; k++)
        seen[k] = frame->row[NORTH][k] * direction[NORTH] + frame->row[EAST][k] * direction[EAST] +
                  frame->row[DOWN][k] * direction[DOWN];
    double aside = hypot(seen[HIGH], seen[RIGHT]), angle = atan2(aside, seen[AHEAD]);
    for (int d = 0; d < 2; d++) a[d] = aside > 0 ? angle * seen[d] / aside : 0.0;
}

/* The frame of a bit at an inclination and azimuth, with e₂ to where the inclination grows. */
static inline Frame frame_of(double inclination, double azimuth) {
    double sine = sin(inclination), cosine = cos(inclination), north = cos(azimuth), east = sin(azimuth);
    Frame frame = {{{cosine * north, -east, sine * north}, {cosine * east, north, sine * east}, {-sine, 0.0, cosine}}};
    return frame;
}

#endif
