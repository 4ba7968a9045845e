/* What a call returns, what a problem is, and the checks of numbers that come from outside. */
#ifndef BOREPROP_CHECKS_H
#define BOREPROP_CHECKS_H

#include "numbers.h"
#include "problems.h"

/* FAILED: there is a problem, and the bit has not moved. FULL: the memory is too small; more of it, and the same call
   goes on. */
typedef enum { DONE, FAILED, FULL } Status;

/* What is wrong: all that its sentence is made of. NaN stands for a number that it does not have. */
typedef struct {
    Code code;
    Name quantity;                      /* what has the wrong value */
    int index;                          /* which of several values, counted from 1; 0 for a single value */
    double value, before, limit, place; /* before: the value before it, of a list; place: m from the start of the run */
} Problem;

/* Note what is wrong with a value. Returns 0, for `return wrong(…)`. */
static inline int wrong(Problem *problem, Code code, Name quantity, int index, double value, double limit) {
    Problem found = {code, quantity, index, value, NAN, limit, NAN};
    *problem = found;
    return 0;
}

/* Note an obstacle on the way. Returns FAILED, for `return met(…)`. */
static inline Status met(Problem *problem, Code code, double limit, double place) {
    Problem found = {code, Q_NOTHING, 0, NAN, NAN, limit, place};
    *problem = found;
    return FAILED;
}

/* Whether the value is finite, > above, >= at_least and <= at_most. */
static inline int check_number(
    Name quantity, int index, double value, double above, double at_least, double at_most, Problem *problem
) {
    if (!isfinite(value)) return wrong(problem, NOT_A_NUMBER, quantity, index, value, NAN);
    if (value <= above) return wrong(problem, NOT_ABOVE, quantity, index, value, above);
    if (value < at_least) return wrong(problem, TOO_SMALL, quantity, index, value, at_least);
    if (value > at_most) return wrong(problem, TOO_LARGE, quantity, index, value, at_most);
    return 1;
}

static inline int check_finite(Name quantity, int index, double value, Problem *problem) {
    return check_number(quantity, index, value, -INFINITY, -INFINITY, INFINITY, problem);
}

static inline int check_positive(Name quantity, double value, Problem *problem) {
    return check_number(quantity, 0, value, 0.0, -INFINITY, INFINITY, problem);
}

static inline int check_at_most(Name quantity, double value, double at_most, Problem *problem) {
    return check_number(quantity, 0, value, -INFINITY, -INFINITY, at_most, problem);
}

/* Whether every value is finite and larger than the one before. */
static inline int check_increasing(Name quantity, Count count, const double *values, Problem *problem) {
    for (Count i = 0; i < count; i++)
        if (!check_finite(quantity, 0, values[i], problem)) return 0;
    for (Count i = 1; i < count; i++)
        if (values[i] <= values[i - 1]) {
            wrong(problem, NOT_INCREASING, quantity, 0, values[i], NAN);
            problem->before = values[i - 1];
            return 0;
        }
    return 1;
}

#endif
