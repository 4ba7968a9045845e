/* A type for counts, the larger and the smaller of two numbers, and numbers as text. */
#ifndef BOREPROP_NUMBERS_H
#define BOREPROP_NUMBERS_H

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef long long Count; /* of stations, and of pieces of hole: 32 bits are not enough for a long life */

/* A function that would slow down its callers if it were inlined. */
#ifdef __GNUC__
#define APART __attribute__((noinline))
#else
#define APART
#endif

static inline double larger(double a, double b) { return b > a ? b : a; }
static inline double smaller(double a, double b) { return b < a ? b : a; }

/* The number in the format %.*e, %.*f or %.*g, with a decimal point in every locale. */
static inline const char *spell(double value, char form, int digits, char text[32]) {
    char *end = text;
    snprintf(text, 32, form == 'e' ? "%.*e" : form == 'f' ? "%.*f" : "%.*g", digits, value);
    if (!isfinite(value)) return strcpy(text, isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
    for (const char *from = text; *from; from++)
        if (strchr("0123456789+-e", *from)) *end++ = *from;
        else if (end == text || end[-1] != '.') *end++ = '.';
    *end = '\0';
    return text;
}

/* The number with so many digits. */
static inline const char *decimal(double value, int digits, char text[32]) { return spell(value, 'g', digits, text); }

/* The shortest decimal that reads back as the same number, as Python writes it. */
static inline const char *represent(double value, char text[32]) {
    int digits = fabs(value) < DBL_MIN ? 1 : fabs(value) < 1e15 ? 15 : 16; /* from 1e16 on with an exponent */
    char local[32];
    do snprintf(local, sizeof local, "%.*g", digits, value);
    while (strtod(local, NULL) != value && ++digits < 17);
    if (digits == 17 && fabs(value) >= 1e16) spell(value, 'e', 16, text);
    else decimal(value, digits, text);
    return isfinite(value) && !strpbrk(text, ".e") ? strcat(text, ".0") : text;
}

#endif
