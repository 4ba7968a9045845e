/* What a call answers, and the checks of numbers that come from outside. */
#ifndef BOREPROP_CHECKS_H
#define BOREPROP_CHECKS_H

#include "numbers.h"

enum { MESSAGE = 512 };

/* FAILED: `why` says in one line what is wrong, and nothing has moved. FULL: the memory is too small. */
typedef enum { DONE, FAILED, FULL } Status;

/* Whether the value is finite, > above, >= at_least and <= at_most; `why` says what is not. */
static inline int check_number(
    const char *name, double value, double above, double at_least, double at_most, char why[MESSAGE]
) {
    char limit[32], got[32];
    if (isfinite(value) && value > above && value >= at_least && value <= at_most) return 1;
    represent(value, got);
    if (!isfinite(value)) snprintf(why, MESSAGE, "%s: must be a finite number, got %s", name, got);
    else if (value <= above) snprintf(why, MESSAGE, "%s: must be > %s, got %s", name, decimal(above, 6, limit), got);
    else if (value < at_least)
        snprintf(why, MESSAGE, "%s: must be >= %s, got %s", name, decimal(at_least, 6, limit), got);
    else snprintf(why, MESSAGE, "%s: must be <= %s, got %s", name, decimal(at_most, 6, limit), got);
    return 0;
}

static inline int check_finite(const char *name, double value, char why[MESSAGE]) {
    return check_number(name, value, -INFINITY, -INFINITY, INFINITY, why);
}

static inline int check_positive(const char *name, double value, char why[MESSAGE]) {
    return check_number(name, value, 0.0, -INFINITY, INFINITY, why);
}

static inline int check_at_least(const char *name, double value, double at_least, char why[MESSAGE]) {
    return check_number(name, value, -INFINITY, at_least, INFINITY, why);
}

/* Whether every value is finite and larger than the one before. */
static inline int check_increasing(const char *name, Count count, const double *values, char why[MESSAGE]) {
    char before[32], after[32];
    for (Count i = 0; i < count; i++)
        if (!check_finite(name, values[i], why)) return 0;
    for (Count i = 1; i < count; i++)
        if (values[i] <= values[i - 1]) {
            represent(values[i - 1], before), represent(values[i], after);
            snprintf(why, MESSAGE, "%s: must increase, got (%s, %s)", name, before, after);
            return 0;
        }
    return 1;
}

#endif
