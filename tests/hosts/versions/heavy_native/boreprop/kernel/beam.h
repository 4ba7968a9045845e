/* Another version: the weight of the BHA loads the bit more, by 7/5. */
#ifndef BOREPROP_HEAVY_BEAM_H
#define BOREPROP_HEAVY_BEAM_H

#define make_beam make_beam_before
#include "beam_before.h"
#undef make_beam

static inline void make_beam(Beam *beam, const Scaled *scaled, Axial axial) {
    make_beam_before(beam, scaled, axial);
    beam->F0_g *= 7.0 / 5;
}

#endif
