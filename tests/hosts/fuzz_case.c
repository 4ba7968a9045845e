/* Spoils the case of the native FMU, resources/case.txt, at random: an instance must come to be or be refused.

   fuzz_case SEED COUNT FOLDER [FIRST]

   FOLDER is that of an unpacked FMU, in which spoilt/case.txt is written. Compile it as fuzz_native.c. What must hold:
   an FMU that is refused says so in one line, and one that is not can be initialized and take a step, or says why not;
   and what is read is never more than there is. */
#define _XOPEN_SOURCE 700
#include "fuzz.h"

static char *good; /* the text of the case */
static char spoilt_folder[1024], spoilt_path[1024 + 16];

/* What people and programs do to a text: another byte, a piece less, a piece twice, something put in. */
static size_t spoil(char *text, size_t size, size_t room) {
    static const char *const pieces[] = {"\n",    "\r\n", " ",    "nan", "1e999",
                                         "-1",    "0",    "1e18", "[",   "stations 99999999\n",
                                         "guid ", "\xFF", "%s%n", "7"};
    size_t at = below(size + 1), length = below(below(2) ? 8 : size - at + 1);
    char number_text[32];
    const char *piece = pieces[below(sizeof pieces / sizeof *pieces)];
    if (below(4) == 0) piece = represent(any_number(1.0), number_text);
    if (length > size - at) length = size - at;
    switch (below(5)) {
        case 0:
            if (at < size) text[at] = (char)below(256);
            return size;
        case 1: memmove(text + at, text + at + length, size - at - length); return size - length;
        case 2: return at;
        case 3:
            if (size + length > room) return size;
            memmove(text + at + length, text + at, size - at);
            return size + length;
        default:
            length = strlen(piece);
            if (size + length > room) return size;
            memmove(text + at + length, text + at, size - at);
            memcpy(text + at, piece, length);
            return size + length;
    }
}

static void write_spoilt(void) {
    size_t size = strlen(good), room = 2 * size + 64;
    char *text = malloc(room);
    remove(spoilt_path); /* some systems write a file that is overwritten to the disk at once */
    FILE *file = fopen(spoilt_path, "wb");
    must(text && file, "a case must be written");
    strcpy(text, good);
    for (size_t times = below(4); times--;) size = spoil(text, size, room);
    must(fwrite(text, 1, size, file) == size, "a case must be written");
    fclose(file);
    free(text);
}

/* How a host may name the folder, rightly or wrongly. */
static const char *name_folder(char name[LINE + 64]) {
    static const char *const schemes[] = {"", "file:", "file://", "file://localhost", "FILE:", "file://%2F", "%"};
    if (below(32) == 0) return NULL;
    snprintf(name, LINE + 64, "%s%s", schemes[below(sizeof schemes / sizeof *schemes)], spoilt_folder);
    for (size_t times = below(4) ? 0 : below(3); times--;) name[below(strlen(name) + 1)] = "%/:\xC3"[below(4)];
    while (below(64) == 0 && strlen(name) < LINE + 32) strcat(name, "/////////////////////////////");
    return name;
}

static void try_case(void) {
    char name[LINE + 64];
    long before = lines;
    double value;
    write_spoilt();
    fmi2Component c =
        fmi2Instantiate("one", fmi2CoSimulation, packed.guid, name_folder(name), &callbacks, 0, listening);
    must(c ? lines == before : lines == before + 1, "an instance must be there, or one line that says why not");
    if (!c) return;
    CALL(fmi2EnterInitializationMode(c));
    CALL(fmi2ExitInitializationMode(c));
    const Variables *all = &((Component *)c)->packed.variables;
    for (unsigned i = 0; i < (unsigned)all->count; i++) fmi2GetReal(c, &i, 1, &value);
    CALL(fmi2DoStep(c, 0.0, 1e-3, 1));
    fmi2FreeInstance(c);
}

int main(int count, char **arguments) {
    size_t size;
    if (count < 4) {
        fprintf(stderr, "fuzz_case SEED COUNT FOLDER [FIRST]\n");
        return 2;
    }
    uint64_t inputs = strtoull(arguments[2], NULL, 10), first = count > 4 ? strtoull(arguments[4], NULL, 10) : 0;
    seed = strtoull(arguments[1], NULL, 10), showing = inputs == 1, listening = 1;
    open_fmu(arguments[3]);
    snprintf(spoilt_path, sizeof spoilt_path, "%s/case.txt", resources);
    FILE *file = fopen(spoilt_path, "rb");
    good = file ? read_all(file, &size) : NULL;
    must(good != NULL, "the case must be read");
    fclose(file);
    snprintf(spoilt_folder, sizeof spoilt_folder, "%s/spoilt", arguments[3]);
    snprintf(spoilt_path, sizeof spoilt_path, "%s/case.txt", spoilt_folder);
    signal(SIGPROF, give_up_waiting);
    for (number = first; number < first + inputs; number++) {
        drawn = mix(seed) ^ mix(number + 1);
        setitimer(ITIMER_PROF, &(struct itimerval){{0, 0}, {SECONDS, 0}}, NULL);
        try_case();
    }
    printf("%llu inputs, %ld lines in the log\n", (unsigned long long)inputs, lines);
    free(good);
    free(packed.stations);
    return 0;
}
