/* For fuzz_native.c: chance, and an instance of the FMU as it is seen from outside. */
#ifndef FUZZ_INSTANCE_H
#define FUZZ_INSTANCE_H

#include "fmi2.c"
#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { SECONDS = 2 };               /* of the processor, that one life may take */
static const double FARTHEST = 4.0; /* ℓ₁ that one step is asked to drill: the work grows with it */

static uint64_t seed, number, drawn;
static char survey_path[1024];
static long lines;    /* in the log */
static int listening; /* whether there is a log */
static int showing;   /* the log, where there is one life only */
static int tampered;  /* whether a state that no run has saved was taken */

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

static double good_number(double usual) { return usual * between(0.7, 1.4); }

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
    must(environment == &lines && name && status == fmi2Error, "a line must say whose it is");
    must(!strcmp(category, CATEGORY), "a line must be of a category");
    must(length > 0 && length < LINE && is_utf8(line) && !strchr(line, '\n'), "a message must be one line of text");
    lines++;
}

static const fmi2CallbackFunctions callbacks = {listen, calloc, free, NULL, &lines};

static fmi2Component born(int logging) {
    fmi2Component c = fmi2Instantiate("one", fmi2CoSimulation, GUID, NULL, &callbacks, 0, logging);
    must(c != NULL, "fmi2Instantiate must give an instance");
    return c;
}

/* The status of a call that may say no, with a line in the log since there were `before`. */
static fmi2Status answered(fmi2Status status, long before) {
    must(status == fmi2OK || status == fmi2Discard || status == fmi2Error, "a status must be OK, Discard or Error");
    must(status == fmi2OK || lines > before || !listening, "what is refused must be logged");
    return status;
}
#define CALL(expression) answered(expression, lines)

/* What can be seen of an instance: every number. */
typedef struct {
    fmi2Status status;
    double value[VARIABLES];
} Sight;

static Sight look(fmi2Component c) {
    Sight sight = {fmi2OK, {0}};
    for (unsigned i = 0; i < VARIABLES; i++) {
        int whole = 0;
        fmi2Status status = fmi2OK;
        if (VARIABLE[i].kind == REAL) status = fmi2GetReal(c, &i, 1, &sight.value[i]);
        if (VARIABLE[i].kind == INTEGER) status = fmi2GetInteger(c, &i, 1, &whole), sight.value[i] = whole;
        must(status == fmi2OK || status == fmi2Error, "a value must be OK or an error");
        if (status != fmi2OK) sight.status = status;
        if (VARIABLE[i].role == OUTPUT && status == fmi2OK) must(isfinite(sight.value[i]), "an output must be finite");
        must(status == fmi2OK || VARIABLE[i].role == OUTPUT, "an input or a parameter must have a value");
    }
    return sight;
}

static void must_be_same(Sight a, Sight b, const char *what) {
    must(a.status == b.status && !memcmp(a.value, b.value, sizeof a.value), what);
}

/* A state as bytes. */
typedef struct {
    fmi2Byte *bytes;
    size_t size;
} Content;

static Content serialized(fmi2Component c) {
    fmi2FMUstate state = NULL;
    Content content = {NULL, 0};
    must(fmi2GetFMUstate(c, &state) == fmi2OK, "a state must be got");
    must(fmi2SerializedFMUstateSize(c, state, &content.size) == fmi2OK, "a state must have a size");
    content.bytes = malloc(content.size);
    must(fmi2SerializeFMUstate(c, state, content.bytes, content.size) == fmi2OK, "a state must be serialized");
    must(fmi2FreeFMUstate(c, &state) == fmi2OK && !state, "a state must be freed");
    return content;
}

static int is_same(Content a, Content b) { return a.size == b.size && !memcmp(a.bytes, b.bytes, a.size); }

/* Whether the instance takes these bytes as its state; if not nothing has moved. */
static int takes(fmi2Component c, Content content) {
    fmi2FMUstate state = NULL;
    fmi2Status status = CALL(fmi2DeSerializeFMUstate(c, content.bytes, content.size, &state));
    must((status == fmi2OK) == (state != NULL), "a state must be there if it is OK");
    if (status != fmi2OK) return 0;
    status = CALL(fmi2SetFMUstate(c, state));
    fmi2FreeFMUstate(c, &state);
    return status == fmi2OK;
}

#endif
