/* The serialized state of an instance: a line "FORMAT GUID SIZE CHECKSUM", then the body: doubles, each as eight bytes,
   least significant first, whatever the machine, and text at its end. */
#ifndef BOREPROP_SERIALIZED_H
#define BOREPROP_SERIALIZED_H

#include "text.h"

#define STATE_FORMAT "boreprop-native-fmu-state-7"
enum { SEAL = sizeof STATE_FORMAT + 71 }; /* bytes of the line: all but the format are of fixed width */

/* A body. */
typedef struct {
    size_t size;
    unsigned char *bytes;
} Saved;

static unsigned char *put_double(unsigned char *to, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; i++) *to++ = (unsigned char)(bits >> 8 * i & 0xFF);
    return to;
}

static double get_double(const unsigned char **from) {
    double value;
    uint64_t bits = 0;
    for (int i = 0; i < 8; i++) bits |= (uint64_t)*(*from)++ << 8 * i;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* FNV-1a, 64 bits. */
static uint64_t checksum(const unsigned char *bytes, size_t size) {
    uint64_t sum = 0xCBF29CE484222325u;
    while (size--) sum = (sum ^ *bytes++) * 0x100000001B3u;
    return sum;
}

/* The line before a body; gives its length, SEAL. */
static int seal(const char *guid, const unsigned char *body, size_t size, char line[SEAL + 1]) {
    uint64_t sum = checksum(body, size);
    char text[2 * SEAL];
    int length = snprintf(
        text, sizeof text, "%s %36s %16lu %08lx%08lx\n", STATE_FORMAT, guid, (unsigned long)size,
        (unsigned long)(sum >> 32), (unsigned long)(sum & 0xFFFFFFFFu)
    );
    memcpy(line, text, SEAL + 1);
    return length;
}

/* Whether these bytes are a state that is whole and of this FMU; if not, `why`. */
static int is_sealed(const unsigned char *bytes, size_t size, const char *guid, char why[LINE]) {
    char line[SEAL + 1], got[SHOWN], shown[SHOWN];
    size_t length = size < SHOWN - 1 ? size : SHOWN - 1;
    if (size >= SEAL && seal(guid, bytes + SEAL, size - SEAL, line) == SEAL && !memcmp(line, bytes, SEAL)) return 1;
    for (size_t i = 0; i < length; i++) got[i] = bytes[i] >= ' ' && bytes[i] < 0x7F ? (char)bytes[i] : '?';
    got[length] = '\0';
    return explain(why, "state: must be one of this FMU, %s %s, got %s", STATE_FORMAT, guid, quoted(got, shown));
}

#endif
