/* For fuzz_native.c and fuzz_case.c: the FMU, chance, and what must hold of every call. */
#ifndef FUZZ_H
#define FUZZ_H

#include "fmi2.c"
#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { SECONDS = 2 }; /* of the processor, that one life may take */

static uint64_t seed, number, drawn;
static char survey_path[1024], resources[1024];
static PackedCase packed; /* of the FMU, as this program has read it */
static long lines;        /* in the log */
static int listening;     /* whether discards are logged */
static int showing;       /* the log, where there is one life only */

static void give_up(const char *what) {
    fprintf(stderr, "input %llu of seed %llu: %s\n", (unsigned long long)number, (unsigned long long)seed, what);
    abort();
}

static void must(int holds, const char *what) {
    if (!holds) give_up(what);
}

static void give_up_waiting(int signal_number) {
    static const char what[] = "an input took too long\n";
    (void)signal_number;
    if (write(STDERR_FILENO, what, sizeof what - 1) > 0) give_up("must end in time");
    abort();
}

/* Chance (splitmix64) */

static uint64_t mix(uint64_t x) {
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return x ^ x >> 31;
}

static uint64_t draw(void) { return mix(drawn += 0x9E3779B97F4A7C15u); }

static size_t below(size_t count) { return (size_t)(draw() % count); }

static double between(double low, double high) { return low + (high - low) * (double)(draw() >> 11) * 0x1p-53; }

static double any_number(double usual) {
    static const double odd[] = {
        0.0,    1.0,         1e-12,           1e-6, 1e6, 1e12, 1e300, 1.7976931348623157e308, 2.2250738585072014e-308,
        5e-324, (double)NAN, (double)INFINITY
    };
    uint64_t bits = draw();
    double value;
    switch (below(8)) {
        case 0: return odd[below(sizeof odd / sizeof *odd)];
        case 1: return -odd[below(sizeof odd / sizeof *odd)];
        case 2: return -usual;
        case 3: return usual * pow(10.0, between(-12.0, 12.0));
        case 4: memcpy(&value, &bits, sizeof value); return value;
        default: return usual * pow(10.0, between(-1.5, 1.5));
    }
}

/* What is asked of an instance */

static void listen(
    fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String message,
    ...
) {
    char line[2 * LINE];
    va_list arguments;
    va_start(arguments, message);
    int length = vsnprintf(line, sizeof line, message, arguments);
    va_end(arguments);
    if (showing) fprintf(stderr, "%s\n", line);
    must(environment == &lines && name, "a line must say whose it is");
    int warns = status == fmi2Warning; /* of a BHA outside its hole, whatever comes of the call */
    const char *expected = warns ? WARNINGS : status == fmi2Discard ? DISCARDS : ERRORS;
    must(!strcmp(category, expected), "a line must be of the category of its status");
    must(warns || status == fmi2Error || (listening && status == fmi2Discard), "a line must be wanted");
    must(length > 0 && length < LINE && is_utf8(line) && !strchr(line, '\n'), "a message must be one line of text");
    lines += !warns;
}

/* The folder of an unpacked FMU. */
static void open_fmu(const char *folder) {
    char why[LINE];
    snprintf(survey_path, sizeof survey_path, "%s/survey.csv", folder);
    snprintf(resources, sizeof resources, "%s/resources", folder);
    must(read_case(resources, &packed, why), "the case must be read");
}

static const fmi2CallbackFunctions callbacks = {listen, calloc, free, NULL, &lines};

/* The status of a call that may say no, with a line in the log since there were `lines_before`. */
static long lines_before;
static fmi2Status answered(fmi2Status status) {
    must(status == fmi2OK || status == fmi2Discard || status == fmi2Error, "a status must be OK, Discard or Error");
    must(status == fmi2OK || lines > lines_before || !listening, "what is refused must be logged");
    return status;
}
#define CALL(expression) (lines_before = lines, answered(expression))

#endif
