/* The survey of the existing hole as it is given; hole.h makes pieces of hole from it. */
#ifndef BOREPROP_SURVEY_H
#define BOREPROP_SURVEY_H

#include "checks.h"

#define HALF_TURN 3.141592653589793 /* rad: no hole is inclined by more, to either side */

/* The existing hole: inclination (rad) at measured depths (m), linear in between, straight above the first station.
   The last station is the bit at the start of the run. */
typedef struct {
    Count count;
    const double *measured_depth, *inclination;
} Survey;

static inline int check_survey(const Survey *survey, Problem *problem) {
    if (survey->count < 1) return wrong(problem, NO_STATION, Q_MEASURED_DEPTH, 0, NAN, NAN);
    if (!check_increasing(Q_MEASURED_DEPTH, survey->count, survey->measured_depth, problem)) return 0;
    for (Count k = 0; k < survey->count; k++)
        if (!check_number(Q_INCLINATION, (int)k + 1, survey->inclination[k], -INFINITY, -HALF_TURN, HALF_TURN, problem))
            return 0;
    return 1;
}

/* Whether the survey begins within the reach of the BHA; then a station is added above it. */
static inline int starts_late(const Survey *survey, double length_scale, double reach) {
    return (survey->measured_depth[0] - survey->measured_depth[survey->count - 1]) / length_scale >= -reach;
}

/* Position of station k of the survey, in ℓ₁ from the bit, and the inclination there. */
static inline double station(const Survey *survey, double length_scale, double reach, Count k, double *inclination) {
    int late = starts_late(survey, length_scale, reach);
    Count own = k - (late && k > 0);
    double xi = (survey->measured_depth[own] - survey->measured_depth[survey->count - 1]) / length_scale;
    *inclination = survey->inclination[own];
    return late && k == 0 ? smaller(xi, -reach) - 1.0 : xi;
}

/* Number of the last station above the reach of the BHA; `count` is the number of all stations. */
static inline Count first_station(const Survey *survey, double length_scale, double reach, Count *count) {
    double inclination;
    Count first = 0;
    *count = survey->count + starts_late(survey, length_scale, reach);
    while (first + 1 < *count && station(survey, length_scale, reach, first + 1, &inclination) <= -reach) first++;
    return first;
}

#endif
