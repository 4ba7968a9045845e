/* Leads many short lives of the native FMU at random, and asks after every call what must always hold.

   fuzz_native SEED COUNT FOLDER [FIRST]

   FOLDER is that of an unpacked FMU, in which survey files are written. One program with the FMU: compile this file with
   its sources/ and the headers of FMI 2.0 on the include path, with -fsanitize=address,undefined,float-cast-overflow. An input is one life, number FIRST (0) on: an
   instance is made, set, initialized, and gets up to fifteen random things to do. Chance depends on SEED and the number
   of the life only, so `fuzz_native SEED 1 FOLDER NUMBER` leads one of them again, and shows its log.

   What must hold: a call ends, with fmi2OK, fmi2Discard or fmi2Error, and with a line in the log if it is not OK;
   outputs that are OK are finite; what is refused moves nothing, to the bit; a state that was serialized goes on as the
   instance that it was taken from, to the bit; a state that has been tampered with is refused, or, where the checksum
   was tampered with too, is refused or can be lived with. */
#define _XOPEN_SOURCE 700
#include "fuzz_instance.h"

/* What there is to do */

static double time_of(fmi2Component c) {
    double time = -1.0;
    must(fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &time) == fmi2OK, "the time of the last step must be given");
    return time;
}

/* A size of a step that drills at most so many ℓ₁. */
static double step_size(const Component *c) {
    double rate = c->value[IN_RATE_OF_PENETRATION], l1 = c->value[packed.variables.first_parameter];
    double xi = FARTHEST * pow(10.0, between(-12.0, 0.0)), size = xi * l1 / rate, end_rate;
    if (below(8) == 0) size = any_number(1.0);
    end_rate = rate + c->derivative[IN_RATE_OF_PENETRATION] * size;
    if (isfinite(size) && larger(rate, end_rate) * size > FARTHEST * l1) size = l1 / larger(rate, end_rate);
    return size;
}

/* Whether a step would drill farther, as it may in a state that has been tampered with. */
static int is_too_far(const Component *c, double time, double size) {
    if (!c->run) return 0;
    double from = larger(c->from, c->run->drilling.drilled_length), rate = c->value[IN_RATE_OF_PENETRATION];
    double to = larger(from, from + rate * (time + size - c->since)) / c->value[packed.variables.first_parameter];
    return to - c->run->drilling.integrator.now.step.end > 4 * FARTHEST;
}

static fmi2Status go(fmi2Component c, double size) {
    double time = time_of(c);
    if (is_too_far(c, time, size)) return fmi2OK;
    long before = lines;
    fmi2Status status = CALL(fmi2DoStep(c, below(16) ? time : any_number(time), size, (int)below(2)));
    must(lines <= before + (status != fmi2OK), "a step must say at most one thing");
    return status;
}

static void take_step_at_random(fmi2Component c, int looking) {
    Sight sight;
    Content state = {NULL, 0};
    double time = time_of(c);
    if (looking) sight = look(c), state = serialized(c);
    if (go(c, step_size(c)) != fmi2OK) {
        must(time_of(c) == time || time != time, "a step that is refused must take no time");
        if (looking) {
            Content after = serialized(c);
            must(is_same(state, after), "a step that is refused must leave the state");
            must_be_same(sight, look(c), "a step that is refused must move nothing");
            free(after.bytes);
        }
    }
    free(state.bytes);
}

static void set_at_random(fmi2Component c, Role role, int wild) {
    for (unsigned i = 0; i < (unsigned)packed.variables.count; i++) {
        double usual = packed.start[i] != 0.0 ? packed.start[i] : 1e4;
        if (packed.variables.at[i].role != role || packed.variables.at[i].kind != REAL || below(2)) continue;
        double value = wild && below(4) == 0 ? any_number(usual) : good_number(usual);
        CALL(fmi2SetReal(c, &i, 1, &value));
    }
}

static void bend_at_random(fmi2Component c, int wild) {
    static const unsigned input[INPUT_COUNT] = {IN_RSS_FORCE, IN_ACTIVE_WEIGHT_ON_BIT, IN_RATE_OF_PENETRATION};
    static const int order[INPUT_COUNT] = {1, 1, 1};
    double slope[INPUT_COUNT];
    for (int i = 0; i < INPUT_COUNT; i++) {
        double usual = ((Component *)c)->value[i] * between(-1.0, 1.0);
        slope[i] = wild && below(4) == 0 ? any_number(1.0) : below(3) ? 0.0 : usual;
    }
    CALL(fmi2SetRealInputDerivatives(c, input, INPUT_COUNT, order, slope));
}

/* There and back within one instance, and on from there in another one. */
static void there_and_back(fmi2Component c) {
    fmi2FMUstate kept = NULL;
    fmi2Component other = born(listening);
    Sight sight = look(c);
    Content content = serialized(c), again;
    if (!takes(other, content)) {
        must(tampered, "a serialized state must be taken");
        fmi2FreeInstance(other);
        free(content.bytes);
        return;
    }
    must(fmi2GetFMUstate(c, &kept) == fmi2OK, "a state must be got");
    again = serialized(other);
    must(is_same(content, again), "a state must be what was set");
    must_be_same(look(other), sight, "a serialized state must look the same");
    take_step_at_random(c, 0);
    must(fmi2SetFMUstate(c, kept) == fmi2OK, "a state must be set");
    must(fmi2FreeFMUstate(c, &kept) == fmi2OK && !kept, "a state must be freed");
    must_be_same(look(c), sight, "a state must look the same");
    double time = time_of(c), size = step_size(c);
    if (!is_too_far(c, time, size)) {
        fmi2Status status = CALL(fmi2DoStep(c, time, size, 1));
        must(fmi2DoStep(other, time, size, 1) == status, "a serialized state must go on the same way");
        must_be_same(look(other), look(c), "a serialized state must get to the same place");
    }
    fmi2FreeInstance(other);
    free(again.bytes);
    free(content.bytes);
}

static void tamper(fmi2Component c) {
    Sight sight = look(c);
    Content good = serialized(c), bad = {malloc(good.size + 64), good.size};
    fmi2Byte *body = bad.bytes + SEAL;
    memcpy(bad.bytes, good.bytes, good.size);
    memset(bad.bytes + good.size, (int)below(256), 64);
    switch (below(4)) {
        case 0: bad.size = below(4) ? below(good.size) : SEAL + 8 * below((good.size - SEAL) / 8); break;
        case 1: bad.size += below(64); break;
        case 2:
            for (size_t flips = 1 + below(4); flips--;) bad.bytes[below(good.size)] ^= (fmi2Byte)(1 << below(8));
            break;
        default:
            for (size_t times = 1 + below(3); times--;) {
                static const double COUNTS[] = {-1, 0, 1, 2, 4, 8, 1e6, 9e15, 1e18, 1e19, -1e19};
                unsigned char *at = (unsigned char *)body + 8 * below(below(2) ? FIXED : (good.size - SEAL) / 8);
                const unsigned char *from = at;
                double count = COUNTS[below(sizeof COUNTS / sizeof *COUNTS)];
                put_double(at, below(2) ? count : any_number(get_double(&from)));
            }
    }
    int intact = is_same(good, bad), mended = bad.size >= SEAL && below(4) > 0;
    if (mended) {
        char line[SEAL + 1];
        seal(packed.guid, (unsigned char *)body, bad.size - SEAL, line);
        memcpy(bad.bytes, line, SEAL);
    }
    int taken = takes(c, bad);
    if (taken && !intact) tampered = 1;
    must(!taken || mended || intact, "a state that was tampered with must be refused");
    if (!taken) {
        Content after = serialized(c);
        must(is_same(good, after), "a state that is refused must leave the present one");
        must_be_same(look(c), sight, "a state that is refused must move nothing");
        free(after.bytes);
    }
    free(bad.bytes);
    free(good.bytes);
}

static void ask_nonsense(fmi2Component c) {
    size_t variables = (size_t)packed.variables.count;
    unsigned reference[3] = {(unsigned)below(variables + 2), (unsigned)below(variables), (unsigned)draw()};
    double value[3] = {any_number(1.0), any_number(1.0), any_number(1.0)};
    int whole[3] = {(int)draw(), (int)below(3), 0};
    const char *text[3] = {"\xFF", "%s%n", "no\nwhere.csv"};
    const unsigned *references = below(8) ? reference : NULL;
    double *values = below(8) ? value : NULL;
    int *wholes = below(8) ? whole : NULL;
    const char **texts = below(8) ? text : NULL;
    size_t count = below(4), size = 0;
    fmi2Boolean flag;
    fmi2Status status;
    fmi2FMUstate none = NULL;
    if (below(8) == 0) text[0] = NULL;
    if (below(16) == 0) c = NULL;
    int unheard = listening;
    if (!c) listening = 0;
    switch (below(24)) {
        case 0: fmi2GetReal(c, references, count, values); break; /* what cannot be computed is logged once */
        case 1: fmi2GetInteger(c, references, count, wholes); break;
        case 2: CALL(fmi2GetBoolean(c, references, count, wholes)); break;
        case 3: CALL(fmi2GetString(c, references, count, texts)); break;
        case 4: CALL(fmi2SetReal(c, references, count, values)); break;
        case 5: CALL(fmi2SetInteger(c, references, count, wholes)); break;
        case 6: CALL(fmi2SetBoolean(c, references, count, wholes)); break;
        case 7: CALL(fmi2SetString(c, references, count, texts)); break;
        case 8: CALL(fmi2SetRealInputDerivatives(c, references, count, wholes, values)); break;
        case 9: CALL(fmi2GetRealOutputDerivatives(c, references, count, wholes, values)); break;
        case 10: CALL(fmi2GetDirectionalDerivative(c, references, count, references, count, values, values)); break;
        case 11: CALL(fmi2CancelStep(c)); break;
        case 12: CALL(fmi2GetStatus(c, (fmi2StatusKind)below(5), below(2) ? &status : NULL)); break;
        case 13: CALL(fmi2GetRealStatus(c, (fmi2StatusKind)below(5), values)); break;
        case 14: CALL(fmi2GetIntegerStatus(c, (fmi2StatusKind)below(5), wholes)); break;
        case 15: CALL(fmi2GetBooleanStatus(c, (fmi2StatusKind)below(5), below(2) ? &flag : NULL)); break;
        case 16: CALL(fmi2GetStringStatus(c, (fmi2StatusKind)below(5), texts)); break;
        case 17: CALL(fmi2SetupExperiment(c, 0, 0.0, values ? *values : 0.0, 1, 1.0)); break;
        case 18: CALL(fmi2EnterInitializationMode(c)); break;
        case 19: CALL(fmi2ExitInitializationMode(c)); break;
        case 20: CALL(fmi2Terminate(c)); break;
        case 21: CALL(fmi2SetFMUstate(c, NULL)); break;
        case 22: CALL(fmi2DeSerializeFMUstate(c, below(2) ? "" : NULL, 0, &none)); break;
        default: CALL(fmi2SerializedFMUstateSize(c, NULL, &size));
    }
    listening = unheard;
}

/* Instances that must not come to be. */
static void instantiate_wrongly(void) {
    static const fmi2CallbackFunctions silent = {NULL, NULL, NULL, NULL, NULL};
    static const char *const guids[] = {NULL, "", "other", "%n%s"};
    int logging = (int)below(2);
    switch (below(3)) {
        case 0:
            must(!fmi2Instantiate("one", fmi2CoSimulation, packed.guid, resources, NULL, 0, logging), "no callbacks");
            break;
        case 1:
            must(
                !fmi2Instantiate("one", fmi2ModelExchange, packed.guid, resources, &callbacks, 0, logging),
                "no model exchange"
            );
            break;
        default:
            must(
                !fmi2Instantiate(
                    below(2) ? NULL : "%s", fmi2CoSimulation, guids[below(4)], resources,
                    below(2) ? &silent : &callbacks, 0, logging
                ),
                "a wrong guid"
            );
    }
}

static void name_survey(fmi2Component c) {
    static const char *const pieces[] = {
        "measured_depth", "inclination_deg", "other", ",",    ",",  "\n",           "\r\n", "\"", " ", "1", "2.5",
        "-3e2",           "1e400",           "nan",   "1000", "90", "\xEF\xBB\xBF", "\xFF", "é"
    };
    static const char *const headers[] = {
        "measured_depth,inclination_deg\n0,1\n", "\"inclination_deg\",measured_depth\r\n2,5\r\n", ""
    };
    unsigned reference = (unsigned)packed.variables.survey_file;
    const char *path = below(8) ? survey_path : below(2) ? "nowhere/%s.csv" : "no\nwhere.csv";
    FILE *file = fopen(survey_path, "wb");
    must(file != NULL, "a survey file must be written");
    fputs(headers[below(3)], file);
    for (size_t k = below(40); k--;) {
        if (below(12) == 0) fputc((int)below(256), file);
        else if (below(2)) fputs(pieces[below(sizeof pieces / sizeof *pieces)], file);
        else fprintf(file, "%g,%g\n", any_number(1.0), any_number(1.0));
    }
    fclose(file);
    CALL(fmi2SetString(c, &reference, 1, &path));
}

static void initialize(fmi2Component c, int wild) {
    set_at_random(c, PARAMETER, wild);
    set_at_random(c, INPUT, wild);
    if (below(64) == 0) name_survey(c);
    CALL(fmi2SetupExperiment(c, 0, 0.0, below(4) ? 0.0 : wild ? any_number(1.0) : 1e3, 0, 0.0));
    CALL(fmi2EnterInitializationMode(c));
    if (below(4) == 0) set_at_random(c, INPUT, wild);
    CALL(fmi2ExitInitializationMode(c));
}

static void live(void) {
    int wild = below(2) == 0;
    listening = below(8) != 0, tampered = 0;
    fmi2Component c = born(listening);
    if (below(16) == 0) instantiate_wrongly();
    if (below(16)) initialize(c, wild);
    for (size_t k = below(16); k--;) {
        switch (below(16)) {
            case 0:
            case 1: set_at_random(c, INPUT, wild); break;
            case 2: bend_at_random(c, wild); break;
            case 3: look(c); break;
            case 4: there_and_back(c); break;
            case 5:
            case 6: tamper(c); break;
            case 7:
            case 8: ask_nonsense(c); break;
            case 9:
                if (below(4)) break;
                must(fmi2Reset(c) == fmi2OK, "fmi2Reset must work");
                initialize(c, wild);
                break;
            default: take_step_at_random(c, below(2) == 0);
        }
    }
    look(c);
    fmi2FreeInstance(c);
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

int main(int count, char **arguments) {
    if (count < 4) {
        fprintf(stderr, "fuzz_native SEED COUNT FOLDER [FIRST]\n");
        return 2;
    }
    uint64_t inputs = strtoull(arguments[2], NULL, 10), first = count > 4 ? strtoull(arguments[4], NULL, 10) : 0;
    uint64_t slowest_number = first;
    double start = now(), slowest = 0.0;
    seed = strtoull(arguments[1], NULL, 10);
    open_fmu(arguments[3]);
    showing = inputs == 1;
    signal(SIGPROF, give_up_waiting);
    for (number = first; number < first + inputs; number++) {
        double began = now();
        drawn = mix(seed) ^ mix(number + 1);
        setitimer(ITIMER_PROF, &(struct itimerval){{0, 0}, {SECONDS, 0}}, NULL);
        live();
        double took = now() - began;
        if (took > slowest) slowest = took, slowest_number = number;
    }
    free(packed.stations);
    printf("%llu inputs, %.1f s, ", (unsigned long long)inputs, now() - start);
    printf("slowest %.1f ms (%llu), %ld lines in the log\n", 1e3 * slowest, (unsigned long long)slowest_number, lines);
    return 0;
}
