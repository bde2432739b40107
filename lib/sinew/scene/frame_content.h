// SPDX-License-Identifier: GPL-3.0-or-later
// What the frames of a scene contain, as section output specifies.
//
//     const std::vector<std::int32_t> ids = written_particles(settings.output, rest);
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/arrays.h>
#include <sinew/core/vector.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// The particles that frames contain, ascending: those that are in output.region at rest (n x 3,
/// m; `radius`, m), its border included, and of the inside of the body those of
/// output.inside_every. Empty: all of them. `near`: the neighbors at rest; none: searched if
/// needed. Throws bad input for a region without any.
std::vector<std::int32_t> written_particles(const OutputSettings& output, const Points& rest,
                                            double radius, const SharedNeighbors& near = {});

/// The arrays of particles beside those that every scene has: the ones of output.arrays; of bodies
/// of up to 200,000 particles strain_eq; and, where positions alone do not give it later,
/// von_mises: for bonds that break or creep, muscles and a part of the body. output.only leaves
/// both out.
std::vector<std::string_view> additional_arrays(const OutputSettings& output, const Body& body);
/// The words that name them, for requested_arrays().
std::string words_for_arrays(const OutputSettings& output, const Body& body);
/// The same without strain_eq, unless output.arrays names it.
std::string words_asked_for(const OutputSettings& output, const Body& body);

/// The arrays of particles that the surface has as well: `named` by output.skin, and those that it
/// has unasked.
struct ContentOfSkin {
  SkinArrays named;
  std::vector<std::string_view> usual;  ///< measured; none that is named
};
/// Unasked, of bodies of up to 200,000 particles, it has strain_eq and, of materials with bonds,
/// von_mises.
ContentOfSkin content_of_skin(const OutputSettings& output, const Body& body);

/// The fraction of all frames' numbers per particle that is written, by output.every, output.region
/// and output.inside_every.
double written_fraction(const OutputSettings& output, const Points& rest, double radius,
                        const SharedNeighbors& near = {});

}  // namespace sinew
