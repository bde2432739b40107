// SPDX-License-Identifier: GPL-3.0-or-later
// All of a simulation that steps change, to the last bit: from it, a simulation of the same body
// continues as if it had never stopped. Neighbor lists are made again: no bit of positions or
// velocities depends on them. What is not a particle's place or velocity lies in parts, which
// those write and check whose it is.
//
//     const SimulationState state = simulation.save();
//     simulation.restore(state);
//
// A part has columns of numbers; one for each member of a struct whose serialize(archive, value)
// calls archive(name, member) for it:
//
//     put_column(state, "pressures", "numbers", numbers);
//     const std::vector<double> numbers = column_of<double>(state, "pressures", "numbers");
//     put_part(state, "way to rest", relaxation);
//     const auto relaxation = part_of<RelaxationState>(state, "way to rest");
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/vector.h>

namespace sinew {

/// Positions and velocities in a stepper's units.
template <class Coord, class Real>
struct MovingColumns {
  std::array<std::vector<Coord>, 3> x;
  std::array<std::vector<Real>, 3> v;
};
using MovingInDouble = MovingColumns<double, double>;       ///< m from the origin, m/s
using MovingInSingle = MovingColumns<std::int32_t, float>;  ///< lengths and lengths per step

/// The fixed-point units of single precision, and their range; of double precision the origin.
struct FixedPointUnits {
  double length = 1;           ///< m
  Vec3 origin = Vec3::Zero();  ///< m
  Box box;                     ///< around all particles when the units were last checked, m
  double traveled = 0;         ///< upper bound since then, m
};

/// Steps of one size since one of them. In memory alone: those of runs follow a plan.
struct EvenSteps {
  std::int64_t from = 0;
  double since = 0, step = 0;  ///< s; step 0: not known
  double made = 0;             ///< the step made last, s
};

/// Named numbers of a part.
struct StateColumn {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::int32_t>, std::vector<std::uint32_t>,
               std::vector<std::int64_t>>
      numbers;
};

struct StatePart {
  std::string name;
  std::vector<StateColumn> columns;
};

struct SimulationState {
  std::int64_t steps = 0;
  EvenSteps even;
  std::uint64_t body = 0;  ///< checksum of the body, in memory alone; 0: not known
  bool kicked = false;     ///< velocities are half a step behind positions (velocity Verlet)
  std::variant<MovingInDouble, MovingInSingle> moving;
  std::vector<std::uint32_t> order;   ///< each particle's place in the caller's order
  FixedPointUnits fixed_point_units;  ///< double precision uses the origin alone
  std::vector<StatePart> parts;       ///< each name once
  /// An earlier state, to which the simulation may have to go back; none: this one.
  std::shared_ptr<const SimulationState> begun = {};
};

/// The saved state is not one of this stepper, or not valid.
inline Error not_a_state(const std::string& why) {
  return bad_input(
      "the saved state does not fit this body: " + why,
      "restore one that the same scene has saved, or begin the run again with --force");
}

inline const StatePart* find_part(const SimulationState& state, std::string_view name) {
  const auto found = std::find_if(state.parts.begin(), state.parts.end(),
                                  [&](const StatePart& part) { return part.name == name; });
  return found == state.parts.end() ? nullptr : &*found;
}

/// Puts numbers into a part, in place of those of that name; makes a part that is not there.
template <class Number>
void put_column(SimulationState& state, std::string_view part, std::string_view name,
                std::vector<Number> numbers) {
  auto there = std::find_if(state.parts.begin(), state.parts.end(),
                            [&](const StatePart& one) { return one.name == part; });
  if (there == state.parts.end())
    there = state.parts.insert(there, StatePart{std::string(part), {}});
  for (StateColumn& column : there->columns)
    if (column.name == name) return void(column.numbers = std::move(numbers));
  there->columns.push_back({std::string(name), std::move(numbers)});
}

/// Returns numbers of a part; none where the state has no such part. Throws bad input for a part
/// without them, or with others.
template <class Number>
std::vector<Number> column_of(const SimulationState& state, std::string_view part,
                              std::string_view name) {
  const StatePart* there = find_part(state, part);
  if (there == nullptr) return {};
  for (const StateColumn& column : there->columns)
    if (const auto* numbers = std::get_if<std::vector<Number>>(&column.numbers);
        numbers != nullptr && column.name == name)
      return *numbers;
  throw not_a_state("its " + std::string(part) + " lack " + std::string(name));
}

/// Writes a struct's members as columns.
struct PartWriter {
  SimulationState& state;
  std::string_view part;

  template <class Value>
  void operator()(std::string_view name, const Value& value) {
    if constexpr (std::is_same_v<Value, bool>)
      put_column(state, part, name, std::vector<std::int32_t>{value});
    else if constexpr (std::is_arithmetic_v<Value>)
      put_column(state, part, name, std::vector<Value>{value});
    else
      put_column(state, part, name, std::vector(value.begin(), value.end()));
  }
};

/// Reads a struct's members; refuses other numbers of values.
struct PartReader {
  const SimulationState& state;
  std::string_view part;

  template <class Value>
  void operator()(std::string_view name, Value& value) {
    if constexpr (std::is_same_v<Value, bool>)
      value = column<std::int32_t>(name, 1).front() != 0;
    else if constexpr (std::is_same_v<Value, Vec3>)
      value = Vec3(column<double>(name, 3).data());
    else if constexpr (std::is_arithmetic_v<Value>)
      value = column<Value>(name, 1).front();
    else
      value = column_of<typename Value::value_type>(state, part, name);
  }

 private:
  template <class Number>
  std::vector<Number> column(std::string_view name, std::size_t count) const {
    std::vector<Number> numbers = column_of<Number>(state, part, name);
    if (numbers.size() != count)
      throw not_a_state("its " + std::string(part) + " lack " + std::string(name));
    return numbers;
  }
};

/// Puts a struct into a part.
template <class Value>
void put_part(SimulationState& state, std::string_view part, const Value& value) {
  PartWriter writer{state, part};
  serialize(writer, const_cast<Value&>(value));
}

/// Returns the struct of a part; as it begins where the state has no such part. Throws bad input
/// for a part of other columns.
template <class Value>
Value part_of(const SimulationState& state, std::string_view part) {
  Value value;
  PartReader reader{state, part};
  if (find_part(state, part) != nullptr) serialize(reader, value);
  return value;
}

inline bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double one) { return std::isfinite(one); });
}

/// Throws bad input unless there are `particles` positions and velocities, all of them finite.
template <class Coord, class Real>
void check_moving(const MovingColumns<Coord, Real>& moving, std::size_t particles) {
  for (int axis = 0; axis < 3; ++axis) {
    if (moving.x[axis].size() != particles || moving.v[axis].size() != particles)
      throw not_a_state("it is of " + std::to_string(moving.x[axis].size()) + " particles, not " +
                        std::to_string(particles));
    for (std::size_t k = 0; k < particles; ++k)
      if (!std::isfinite(static_cast<double>(moving.x[axis][k])) ||
          !std::isfinite(moving.v[axis][k]))
        throw not_a_state("particle " + std::to_string(k) + " has a value that is not finite");
  }
}

}  // namespace sinew
