/* How many lateral directions there are: one in the plane, and two in space, for which SPACE is defined. */
#ifndef BOREPROP_DIMENSIONS_H
#define BOREPROP_DIMENSIONS_H

#include <math.h>

#ifdef SPACE
enum { DIRECTIONS = 2 };
#else
enum { DIRECTIONS = 1 };
#endif

/* How many numbers evolve: first the angles of the bit, then as many lateral coordinates of the hole; in the plane these
   are θ and Y. AXES: how many coordinates a place in the rock has. */
enum { COMPONENTS = 2 * DIRECTIONS, ANGLE = 0, LATERAL = DIRECTIONS, AXES = DIRECTIONS + 1 };

/* How long a lateral vector is. */
static inline double length_of(const double a[DIRECTIONS]) {
    return DIRECTIONS == 1 ? fabs(a[0]) : sqrt(a[0] * a[0] + a[DIRECTIONS - 1] * a[DIRECTIONS - 1]);
}

#endif
