/* The case that is packed in the FMU, resources/case.txt: a line "name value" for everything that an instance starts
   from, in a fixed order, in SI units. It is written from the table of quantities; whatever else comes is refused. */
#ifndef BOREPROP_PACKED_CASE_H
#define BOREPROP_PACKED_CASE_H

#include "files.h"
#include "ground.h"
#include "survey.h"
#include "variables.h"

#ifndef BOREPROP_SOURCES_DIGEST
#define BOREPROP_SOURCES_DIGEST "unknown" /* compiled by somebody else */
#endif
#define BINARY "boreprop-fmu-sources-" BOREPROP_SOURCES_DIGEST /* a stale binary is known by it, see binaries.py */

enum { GUID_LENGTH = 36 };

typedef struct {
    char guid[GUID_LENGTH + 1];
    Variables variables;
    double hole_radius;           /* m */
    double start[MOST_VARIABLES]; /* by value reference; 0 for outputs */
    Survey survey;
    double *stations; /* the numbers of the survey; to be freed */
    Ground ground;
    double *layers; /* the numbers of the ground, NULL without any; to be freed */
} PackedCase;

/* What is read line by line. */
typedef struct {
    char path[LINE], *at;
    long line;
} CaseFile;

/* The value on the next line, which must be of this name; NULL with `why` if it is not. */
static char *next_value(CaseFile *file, const char *name, char why[LINE]) {
    char *value = file->at, *end = value + strcspn(value, "\r\n"), shown[SHOWN];
    size_t length = strlen(name);
    file->line++;
    file->at = end + (*end == '\r' && end[1] == '\n') + (*end != '\0');
    *end = '\0';
    if (!strncmp(value, name, length) && value[length] == ' ') return value + length + 1;
    explain(why, "%s:%ld: must be '%s' and a value, got %s", file->path, file->line, name, quoted(value, shown));
    return NULL;
}

static int read_number(CaseFile *file, const char *name, double *number, char why[LINE]) {
    char *value = next_value(file, name, why), shown[SHOWN];
    if (!value) return 0;
    if (parse_number(value, number) && isfinite(*number)) return 1;
    quoted(value, shown);
    return explain(why, "%s:%ld: %s: must be a finite number, got %s", file->path, file->line, name, shown);
}

/* A whole number from `least` to `most`. */
static int read_count(CaseFile *file, const char *name, long least, long most, long *count, char why[LINE]) {
    double number;
    char got[32];
    if (!read_number(file, name, &number, why)) return 0;
    *count = number >= (double)least && number <= (double)most ? (long)number : least - 1;
    if (*count >= least && (double)*count == number) return 1;
    represent(number, got);
    return explain(why, "%s:%ld: %s: must be %ld to %ld, got %s", file->path, file->line, name, least, most, got);
}

/* Whose case it is: the guid, and the table of quantities that numbers the variables. */
static int read_identity(CaseFile *file, PackedCase *packed, char why[LINE]) {
    char shown[SHOWN], *guid = next_value(file, "guid", why);
    if (!guid) return 0;
    if (strlen(guid) != GUID_LENGTH || strspn(guid, "0123456789abcdef-") != GUID_LENGTH)
        return explain(why, "%s:%ld: guid: must be a guid, got %s", file->path, file->line, quoted(guid, shown));
    strcpy(packed->guid, guid);
    char *table = next_value(file, "quantities", why);
    if (!table) return 0;
    if (!strcmp(table, QUANTITIES_DIGEST)) return 1;
    quoted(table, shown);
    return explain(why, "%s: quantities: must be %s (%s), got %s", file->path, QUANTITIES_DIGEST, BINARY, shown);
}

static int read_radius(CaseFile *file, PackedCase *packed, char why[LINE]) {
    char fault[LINE];
    double diameter;
    Problem problem;
    if (!read_number(file, NAME[Q_BIT_DIAMETER], &diameter, why)) return 0;
    packed->hole_radius = diameter / 2;
    if (check_positive(Q_BIT_DIAMETER, diameter, &problem)) return 1;
    tell(&problem, fault);
    return explain(why, "%s:%ld: %s", file->path, file->line, fault);
}

/* The survey, column by column; there cannot be more stations than there is text. */
static int read_stations(CaseFile *file, PackedCase *packed, char why[LINE]) {
    static const Name COLUMNS_OF_SURVEY[] = {Q_MEASURED_DEPTH, Q_INCLINATION, Q_AZIMUTH};
    char name[48], fault[LINE];
    long count;
    Problem problem;
    if (!read_count(file, "stations", 1, (long)strlen(file->at) / 2 + 1, &count, why)) return 0;
    double *next = packed->stations = calloc((size_t)count, (DIRECTIONS + 1) * sizeof *next);
    if (!next) return explain(why, "%s: must fit into the memory, got %ld stations", file->path, count);
    for (int column = 0; column <= DIRECTIONS; column++)
        for (long k = 1; k <= count; k++) {
            snprintf(name, sizeof name, "%s[%ld]", NAME[COLUMNS_OF_SURVEY[column]], k);
            if (!read_number(file, name, next++, why)) return 0;
        }
    packed->survey.count = count;
    packed->survey.measured_depth = packed->stations, packed->survey.inclination = packed->stations + count;
    packed->survey.azimuth = DIRECTIONS > 1 ? packed->stations + 2 * count : NULL;
    if (check_survey(&packed->survey, &problem)) return 1;
    tell(&problem, fault);
    return explain(why, "%s: %s", file->path, fault);
}

/* The ground, number by number as ground.h has them; 0 numbers if there is none. */
static int read_ground(CaseFile *file, PackedCase *packed, char why[LINE]) {
    char name[48];
    long count;
    if (!read_count(file, "ground", 0, (long)strlen(file->at) / 2 + (long)ground_size(0), &count, why)) return 0;
    if (!count) return 1;
    int layers = (int)((count - ground_size(0)) / (ROCK + 1));
    if (layers < 0 || ground_size(layers) != count)
        return explain(
            why, "%s:%ld: ground: must be as many numbers as layers have, got %ld", file->path, file->line, count
        );
    packed->layers = calloc((size_t)count, sizeof *packed->layers);
    if (!packed->layers) return explain(why, "%s: must fit into the memory, got %ld numbers", file->path, count);
    for (long k = 0; k < count; k++) {
        snprintf(name, sizeof name, "ground[%ld]", k + 1);
        if (!read_number(file, name, &packed->layers[k], why)) return 0;
    }
    packed->ground = ground_of(layers, packed->layers);
    return 1;
}

static int read_structure(CaseFile *file, Structure *structure, char why[LINE]) {
    long n, sections, axial, points, layered, sensors, space;
    if (!read_count(file, "stabilizers", 1, MAX_STABILIZERS, &n, why)) return 0;
    if (!read_count(file, "sections", 0, MAX_SECTIONS, &sections, why)) return 0;
    if (!read_count(file, "axial_load", 0, 1, &axial, why)) return 0;
    if (!read_count(file, "body_points", 0, MAX_POINTS, &points, why)) return 0;
    if (!read_count(file, "layered", 0, 1, &layered, why)) return 0;
    if (!read_count(file, "sensors", 0, MAX_SENSORS, &sensors, why)) return 0;
    if (!read_count(file, "space", DIRECTIONS - 1, DIRECTIONS - 1, &space, why)) return 0; /* as this is compiled for */
    structure->space = (int)space;
    structure->n = (int)n, structure->sections = (int)sections, structure->axial = (int)axial;
    structure->points = (int)points, structure->layered = (int)layered, structure->sensors = (int)sensors;
    return 1;
}

static int read_lines(CaseFile *file, PackedCase *packed, char why[LINE]) {
    Variables *all = &packed->variables;
    char shown[SHOWN];
    Structure structure;
    if (!read_identity(file, packed, why) || !read_structure(file, &structure, why)) return 0;
    list_variables(all, structure);
    for (int i = 0; i < all->count; i++) {
        const Variable *own = &all->at[i];
        if (own->role == OUTPUT || own->kind == STRING) continue;
        if (!read_number(file, own->name, &packed->start[i], why)) return 0;
        if (!is_value_of(own->kind, packed->start[i]))
            return explain(why, "%s:%ld: %s: must be a whole number", file->path, file->line, own->name);
    }
    if (!read_radius(file, packed, why)) return 0;
    if (!read_stations(file, packed, why) || !read_ground(file, packed, why)) return 0;
    if (!*file->at) return 1;
    file->at[strcspn(file->at, "\r\n")] = '\0';
    quoted(file->at, shown);
    return explain(why, "%s:%ld: must be the end, got %s", file->path, file->line + 1, shown);
}

/* Read the case of an FMU from the folder that the host names; 0 with `why` if it cannot be used. */
static int read_case(const char *resources, PackedCase *packed, char why[LINE]) {
    CaseFile file = {{0}, NULL, 0};
    if (!path_in(resources, "case.txt", file.path, why)) return 0;
    char *text = file.at = read_text(file.path, "text", why);
    int done = text && read_lines(&file, packed, why);
    free(text);
    return done;
}

#endif
