/* Surveys from plain CSV files: columns measured_depth (m), inclination_deg and, in space, perhaps azimuth_deg, by name;
   others, and rows of empty cells, are ignored. What core/columns.py reads in Python. */
#ifndef BOREPROP_SURVEY_FILE_H
#define BOREPROP_SURVEY_FILE_H

#include "files.h"
#include "survey.h"

enum { REQUIRED = 2, COLUMNS = 3 }; /* the third column may be missing, and is not looked for in the plane */

static const char *const COLUMN[COLUMNS] = {"measured_depth", "inclination_deg", "azimuth_deg"};
static const char PLAIN[] = "plain CSV: UTF-8, commas, decimal points, depths in m, inclinations in degrees";
static const double LARGEST_VALUE[COLUMNS] = {INFINITY, 180.0, 360.0};                           /* of either sign */
static const double UNIT[COLUMNS] = {1.0, 3.141592653589793 / 180.0, 3.141592653589793 / 180.0}; /* m, rad */

/* Take one field of a row: `*from` moves behind it, `*field` is its text. Gives the character that ended it. */
static char next_field(char **from, char **field) {
    char *at = *from, *to = at;
    int in_quotes = *at == '"';
    at += in_quotes;
    *field = to;
    for (; *at && (in_quotes || !strchr(",\r\n", *at)); at++) {
        if (in_quotes && *at == '"' && at[1] != '"') in_quotes = 0;
        else {
            at += in_quotes && *at == '"'; /* two of them mean one */
            *to++ = *at;
        }
    }
    char end = *at;
    *from = at + (end != '\0') + (end == '\r' && at[1] == '\n');
    *to = '\0';
    return end;
}

static int is_blank(const char *field) { return field[strspn(field, " \t\v\f\r\n")] == '\0'; }

/* Positions of the columns in the header row, and how many values it has: 0 with `why` if a column is missing. */
static int read_header(const char *path, char **from, int position[COLUMNS], char why[LINE]) {
    char got[LINE / 4] = "", shown[SHOWN], other[SHOWN] = "", *field;
    int count = 0, more = **from != '\0';
    for (int i = 0; i < COLUMNS; i++) position[i] = -1;
    while (more) {
        more = next_field(from, &field) == ',';
        field += strspn(field, " \t");
        for (size_t length = strlen(field); length && strchr(" \t", field[length - 1]);) field[--length] = '\0';
        for (int i = 0; i <= DIRECTIONS; i++)
            if (position[i] < 0 && !strcmp(field, COLUMN[i])) position[i] = count;
        if (DIRECTIONS > 1 && !strncmp(field, "azimuth", 7)) quoted(field, other);
        if (strlen(got) + SHOWN < sizeof got) strcat(strcat(got, count ? ", " : ""), quoted(field, shown));
        count++;
    }
    for (int i = 0; i < REQUIRED; i++)
        if (position[i] < 0)
            return explain(why, "%s: must have a column '%s' (%s), got [%s]", path, COLUMN[i], PLAIN, got);
    if (position[REQUIRED] < 0 && other[0])
        return explain(
            why, "%s: must have the column '%s' (degrees), or none of it, got %s", path, COLUMN[REQUIRED], other
        );
    return count;
}

/* Read the rows under the header into `columns`, of as many numbers as there are lines. Gives their count, or −1. */
static long read_rows(
    const char *path, char *from, long line, int width, const int position[COLUMNS], double *columns[COLUMNS],
    char why[LINE]
) {
    long rows = 0;
    for (; *from; line++) {
        char *field, *text[COLUMNS] = {NULL}, end, shown[SHOWN];
        int count = 0, empty = 1;
        do {
            end = next_field(&from, &field);
            for (int i = 0; i < COLUMNS; i++)
                if (count == position[i]) text[i] = field;
            empty = empty && is_blank(field);
            count++;
        } while (end == ',');
        if (empty) continue;
        if (count != width) {
            explain(why, "%s:%ld: must have %d values like the header, got %d", path, line, width, count);
            return -1;
        }
        for (int i = 0; i < COLUMNS; i++) {
            if (position[i] < 0) continue; /* zero */
            int number = parse_number(text[i], &columns[i][rows]) && isfinite(columns[i][rows]);
            if (number && fabs(columns[i][rows]) <= LARGEST_VALUE[i]) continue;
            quoted(text[i], shown);
            if (!number) explain(why, "%s:%ld: %s: must be a finite number, got %s", path, line, COLUMN[i], shown);
            else {
                double most = LARGEST_VALUE[i];
                explain(
                    why, "%s:%ld: %s: must be between %g and %g, got %s", path, line, COLUMN[i], -most, most, shown
                );
            }
            return -1;
        }
        for (int i = 0; i < COLUMNS; i++) columns[i][rows] *= UNIT[i];
        rows++;
    }
    return rows;
}

/* Read a survey file. Its numbers lie in `*memory`, to be freed; NULL with `why` if it cannot be used. */
static double *read_survey(const char *path, Survey *survey, char why[LINE]) {
    char *text = read_text(path, "CSV", why), *from = text, *blank, fault[LINE];
    double *numbers = NULL, *columns[COLUMNS];
    int position[COLUMNS], width = 0;
    long lines = 1, line = 2, rows = -1;
    Problem problem;
    if (!text) return NULL;
    if (!strncmp(text, "\xEF\xBB\xBF", 3)) from += 3;
    for (;; line++) { /* rows of empty cells */
        size_t length = strspn(from, " \t,\"");
        int end = !from[length];
        if (!end && !strchr("\r\n", from[length])) break;
        from += length;
        if (end) break;
        next_field(&from, &blank);
    }
    for (const char *at = from; *at; at++) lines += *at == '\n' || *at == '\r';
    width = read_header(path, &from, position, why);
    if (width) {
        numbers = calloc((size_t)lines * COLUMNS, sizeof *numbers);
        for (int i = 0; numbers && i < COLUMNS; i++) columns[i] = numbers + i * lines;
        if (numbers) rows = read_rows(path, from, line, width, position, columns, why);
        else explain(why, "%s: must fit into the memory, got %ld lines", path, lines);
    }
    if (rows >= 0) {
        survey->count = rows, survey->measured_depth = columns[0], survey->inclination = columns[1];
        survey->azimuth = DIRECTIONS > 1 ? columns[2] : NULL;
        if (!check_survey(survey, &problem)) {
            tell(&problem, fault);
            explain(why, "%s: %s", path, fault);
            rows = -1;
        }
    }
    free(text);
    if (rows >= 0) return numbers;
    free(numbers);
    return NULL;
}

#endif
