/* Sensors along the BHA, and how a survey instrument reads inclination and azimuth: every so many metres drilled, under the
   inputs that drilled up to there; in between its last reading is held. The noise of a reading depends on nothing but seed,
   sensor and number of the reading, so that any run has it again. */
#ifndef BOREPROP_SENSORS_H
#define BOREPROP_SENSORS_H

#ifdef SPACE
#include "space_response.h"
#else
#include "response.h"
#endif
#include <stdint.h>

#define EARLY 1e-9 /* intervals: a reading is taken this much early, where lengths that were added up end on it */
#define MOST_READINGS 0x1p53 /* beyond this, numbers of readings are no longer exact */
#define PI 3.141592653589793

/* The number that the generator SplitMix64 gives next to this state (Steele, Lea & Flood, OOPSLA 2014). */
static inline uint64_t mixed(uint64_t state) {
    uint64_t z = state + 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
}

/* The number between 0 and 1, never at either, that the upper bits make. */
static inline double share(uint64_t bits) { return ((double)(bits >> 12) + 0.5) * 0x1p-52; }

/* The standard normal numbers of one reading of one sensor, both counted from 0, by Box and Muller; zeros without noise. */
static inline void find_noise(const Sensor *sensor, int i, double number, double noise[2]) {
    noise[0] = noise[1] = 0.0;
    if (!(sensor->noise > 0)) return;
    uint64_t first = mixed(mixed(mixed((uint64_t)sensor->seed) + (uint64_t)i) + (uint64_t)number);
    double size = sqrt(-2 * log(share(first))), angle = 2 * PI * share(mixed(first));
    noise[0] = size * cos(angle), noise[1] = size * sin(angle);
}

/* The BHA at a sensor: its turn from the axis of the bit, its offset from that of the hole, and the bending moment. */
typedef struct {
    double turn[DIRECTIONS], offset[DIRECTIONS], moment[DIRECTIONS];
} Sensed;

/* The BHA at `s` behind the bit while that is at `xi` in the present step, in the state `x`, and bent like this. */
static inline Sensed sensed(
    const Integrator *p, double s, double xi, const double x[COMPONENTS], const Bending bending[DIRECTIONS]
) {
    const Piece *own = piece(&p->now.hole, find(&p->now.hole, xi - s));
    double line[PARTS], way = (xi - s - own->start) * own->rate;
    Sensed found;
    for (int d = 0; d < DIRECTIONS; d++) {
        line_at(&p->modes.beam, &p->scaled, &bending[d], s, line);
        found.turn[d] = -line[SLOPE_OF_BEAM], found.moment[d] = line[MOMENT];
        found.offset[d] = x[LATERAL + d] - polynomial(own->x[LATERAL + d], way) - s * x[ANGLE + d] + line[DEFLECTION];
    }
    return found;
}

/* Inclination and azimuth of the BHA there. */
static inline void find_axis(
    const Step *step, double xi, const double x[COMPONENTS], const Sensed *found, double axis[DIRECTIONS]
) {
#ifdef SPACE
    Frame frame = turned_along(&step->frame, step->x, (xi - step->xi) / step->h);
    double north[3], east[3], down[3];
    turned_row(frame.row[NORTH], found->turn, north), turned_row(frame.row[EAST], found->turn, east);
    turned_row(frame.row[DOWN], found->turn, down);
    axis[INCLINATION] = atan2(hypot(north[AHEAD], east[AHEAD]), down[AHEAD]);
    axis[AZIMUTH] = atan2(east[AHEAD], north[AHEAD]);
    (void)x;
#else
    axis[INCLINATION] = x[ANGLE] + found->turn[0];
    (void)step, (void)xi;
#endif
}

/* What an instrument tells of an axis, with its bias and noise. In space the noise turns it to its sides by as much as up
   and down, and an axis that is brought beyond the vertical has the opposite azimuth. */
static inline void show_axis(
    const Sensor *sensor, const double axis[DIRECTIONS], const double noise[2], double told[DIRECTIONS]
) {
    told[INCLINATION] = axis[INCLINATION] + sensor->bias + sensor->noise * noise[0];
#ifdef SPACE
    double turn = atan2(sensor->noise * noise[1], sin(axis[INCLINATION]));
    told[AZIMUTH] = remainder(axis[AZIMUTH] + turn + (told[INCLINATION] < 0 ? PI : 0.0), 2 * PI);
    told[INCLINATION] = fabs(told[INCLINATION]);
#endif
}

/* Take the last reading that is due with the bit at `xi`, in the present step. */
static inline void read_sensor(Integrator *p, int i, double xi) {
    const Sensor *sensor = &p->scaled.sensor[i];
    Reading *reading = &p->now.reading[i];
    double due = smaller(xi / sensor->interval + EARLY, MOST_READINGS), x[COMPONENTS], axis[DIRECTIONS], noise[2];
    Bending bending[DIRECTIONS];
    if (due < reading->count) return;
    double number = floor(due);
    double at = smaller(number * sensor->interval, xi);
    step_state(&p->now.step, at, x);
    bend(p, at, x, bending);
    Sensed found = sensed(p, sensor->s, at, x, bending);
    find_axis(&p->now.step, at, x, &found, axis);
    find_noise(sensor, i, number, noise);
    show_axis(sensor, axis, noise, reading->told);
    reading->count = number + 1;
}

/* The same for every sensor that reads at intervals. */
static inline void read_sensors(Integrator *p, double xi) {
    for (int i = 0; i < p->scaled.sensors; i++)
        if (p->scaled.sensor[i].interval > 0) read_sensor(p, i, xi);
}

/* The BHA at every sensor with the bit where it is, in the state `x` and bent like this, and what the sensors tell: their
   last readings, or all the time what there is, with their bias. */
static inline void find_sensed(
    const Integrator *p, const double x[COMPONENTS], const Bending bending[DIRECTIONS], Sensed all[MAX_SENSORS],
    double told[MAX_SENSORS][DIRECTIONS]
) {
    static const double nothing[2] = {0.0, 0.0};
    for (int i = 0; i < p->scaled.sensors; i++) {
        const Sensor *sensor = &p->scaled.sensor[i];
        double axis[DIRECTIONS];
        all[i] = sensed(p, sensor->s, p->now.xi, x, bending);
        find_axis(&p->now.step, p->now.xi, x, &all[i], axis);
        if (sensor->interval > 0) memcpy(told[i], p->now.reading[i].told, sizeof told[i]);
        else show_axis(sensor, axis, nothing, told[i]);
    }
}

#endif
