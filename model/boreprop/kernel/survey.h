/* The survey of the existing hole as it is given; hole.h makes pieces of hole from it. */
#ifndef BOREPROP_SURVEY_H
#define BOREPROP_SURVEY_H

#include "checks.h"
#include "dimensions.h"
#include "frame.h"

#define HALF_TURN 3.141592653589793 /* rad: no hole is inclined by more, to either side */

/* The existing hole: inclination (rad) at measured depths (m), linear in between, straight above the first station.
   The last station is the bit at the start of the run. In space it turns between two stations along the great circle from
   one direction to the other, at a constant rate; azimuths (rad) that are not given are zero. */
typedef struct {
    Count count;
    const double *measured_depth, *inclination, *azimuth;
} Survey;

static inline int check_survey(const Survey *survey, Problem *problem) {
    if (survey->count < 1) return wrong(problem, NO_STATION, Q_MEASURED_DEPTH, 0, NAN, NAN);
    if (!check_increasing(Q_MEASURED_DEPTH, survey->count, survey->measured_depth, problem)) return 0;
    for (Count k = 0; k < survey->count; k++)
        if (!check_number(Q_INCLINATION, (int)k + 1, survey->inclination[k], -INFINITY, -HALF_TURN, HALF_TURN, problem))
            return 0;
    for (Count k = 0; k < survey->count && survey->azimuth; k++)
        if (!check_finite(Q_AZIMUTH, (int)k + 1, survey->azimuth[k], problem)) return 0;
    return 1;
}

/* Whether the survey begins within the reach of the BHA; then a station is added above it. */
static inline int starts_late(const Survey *survey, double length_scale, double reach) {
    return (survey->measured_depth[0] - survey->measured_depth[survey->count - 1]) / length_scale >= -reach;
}

/* Number of a station of the survey as it is given, for that with the one that is added. */
static inline Count given_station(const Survey *survey, double length_scale, double reach, Count k) {
    return k - (starts_late(survey, length_scale, reach) && k > 0);
}

/* Position of station k of the survey, in ℓ₁ from the bit. */
static inline double station(const Survey *survey, double length_scale, double reach, Count k) {
    int late = starts_late(survey, length_scale, reach);
    Count own = given_station(survey, length_scale, reach, k);
    double xi = (survey->measured_depth[own] - survey->measured_depth[survey->count - 1]) / length_scale;
    return late && k == 0 ? smaller(xi, -reach) - 1.0 : xi;
}

/* Number of the last station above the reach of the BHA; `count` is the number of all stations. */
static inline Count first_station(const Survey *survey, double length_scale, double reach, Count *count) {
    Count first = 0;
    *count = survey->count + starts_late(survey, length_scale, reach);
    while (first + 1 < *count && station(survey, length_scale, reach, first + 1) <= -reach) first++;
    return first;
}

/* Where the hole heads at a station: its angles, developed from the bit; in space with the frame that has been carried
   along the hole from there. */
typedef struct {
    double angle[DIRECTIONS];
#ifdef SPACE
    Frame frame;
#endif
} Heading;

#ifdef SPACE
static inline double azimuth_at(const Survey *survey, Count k) { return survey->azimuth ? survey->azimuth[k] : 0.0; }

/* Where the hole heads at a station as it is given. */
static inline void direction_at(const Survey *survey, Count k, double direction[3]) {
    double sine = sin(survey->inclination[k]), azimuth = azimuth_at(survey, k);
    direction[NORTH] = sine * cos(azimuth), direction[EAST] = sine * sin(azimuth);
    direction[DOWN] = cos(survey->inclination[k]);
}

#define VERTICAL 1e-12 /* sine of the inclination of a hole that has no high side */

/* At the bit: e₂ points to the high side or, where there is none, to where the last bend of the survey turns the hole,
   else to its azimuth. */
static inline Heading last_heading(const Survey *survey) {
    Count last = survey->count - 1;
    double azimuth = azimuth_at(survey, last), direction[3] = {0};
    Heading heading = {{survey->inclination[last], 0.0}, {{{0}}}};
    if (fabs(sin(survey->inclination[last])) <= VERTICAL)
        for (Count k = last - 1; k >= 0; k--) {
            direction_at(survey, k, direction);
            if (hypot(direction[NORTH], direction[EAST]) <= VERTICAL) continue;
            azimuth = atan2(-direction[EAST], -direction[NORTH]);
            break;
        }
    heading.frame = frame_of(survey->inclination[last], azimuth);
    return heading;
}

/* Go back to the station before, which is number k as it is given. */
static inline void head_back(const Survey *survey, Count k, Heading *heading) {
    double direction[3], turn[DIRECTIONS];
    direction_at(survey, k, direction);
    turn_towards(&heading->frame, direction, turn);
    heading->frame = turn_frame(&heading->frame, turn);
    for (int d = 0; d < DIRECTIONS; d++) heading->angle[d] += turn[d];
}
#else
static inline Heading last_heading(const Survey *survey) {
    Heading heading = {{survey->inclination[survey->count - 1]}};
    return heading;
}

/* Go back to the station before, which is number k as it is given. */
static inline void head_back(const Survey *survey, Count k, Heading *heading) {
    heading->angle[0] = survey->inclination[k];
}
#endif

#endif
