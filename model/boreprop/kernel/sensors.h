/* Sensors along the BHA, and how a survey instrument reads the inclination: every so many metres drilled, under the inputs
   that drilled up to there; in between its last reading is held. The noise of a reading depends on nothing but seed,
   sensor and number of the reading, so that any run has it again. */
#ifndef BOREPROP_SENSORS_H
#define BOREPROP_SENSORS_H

#include "bit.h"
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

/* The standard normal number of one reading of one sensor, both counted from 0, by Box and Muller. */
static inline double normal(double seed, int sensor, double number) {
    uint64_t first = mixed(mixed(mixed((uint64_t)seed) + (uint64_t)sensor) + (uint64_t)number);
    return sqrt(-2 * log(share(first))) * cos(2 * PI * share(mixed(first)));
}

/* The BHA at a sensor: its inclination, its offset from the axis of the hole, and the bending moment. */
typedef struct {
    double inclination, offset, moment;
} Sensed;

/* The BHA at `s` behind the bit while that is at `xi` in the present step, in the state `x` under these loads. */
static inline Sensed sensed(
    const Integrator *p, double s, double xi, const double x[COMPONENTS], const Mode *mode, const Loads *loads
) {
    double line[PARTS], behind = xi - s;
    Bending bending = bending_of(mode, loads, p->scaled.n);
    const Piece *own = piece(&p->now.hole, find(&p->now.hole, behind));
    double Y = polynomial(own->x[LATERAL], (behind - own->start) * own->rate);
    line_at(&p->modes.beam, &p->scaled, &bending, s, line);
    Sensed found = {x[ANGLE] - line[SLOPE_OF_BEAM], x[LATERAL] - Y - s * x[ANGLE] + line[DEFLECTION], line[MOMENT]};
    return found;
}

/* Take the last reading that is due with the bit at `xi`, in the present step. */
static inline void read_sensor(Integrator *p, int i, double xi) {
    const Sensor *sensor = &p->scaled.sensor[i];
    Reading *reading = &p->now.reading[i];
    double number = floor(smaller(xi / sensor->interval + EARLY, MOST_READINGS)), x[COMPONENTS];
    if (number < reading->count) return;
    double at = smaller(number * sensor->interval, xi);
    step_state(&p->now.step, at, x);
    Loads loads = loads_at(p, at, x, force_at(&p->now, at));
    const Mode *mode = settle(&p->modes, &loads, p->now.regime.contact);
    reading->count = number + 1;
    reading->inclination = sensed(p, sensor->s, at, x, mode, &loads).inclination + sensor->bias;
    if (sensor->noise > 0) reading->inclination += sensor->noise * normal(sensor->seed, i, number);
}

/* The same for every sensor that reads at intervals. */
static inline void read_sensors(Integrator *p, double xi) {
    for (int i = 0; i < p->scaled.sensors; i++)
        if (p->scaled.sensor[i].interval > 0) read_sensor(p, i, xi);
}

/* What a sensor tells of the inclination: its last reading, or all the time what there is, with its bias. */
static inline double told(const Integrator *p, int i, const Sensed *present) {
    const Sensor *sensor = &p->scaled.sensor[i];
    return sensor->interval > 0 ? p->now.reading[i].inclination : present->inclination + sensor->bias;
}

#endif
