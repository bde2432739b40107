#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# every_setting.sh BUILD: steps all combinations of materials, damping, bones, surroundings and integrators in the
# kernel and in the reference. The tests step a selection, in which the values of any three occur in every
# combination.
set -euo pipefail

build=${1:?usage: every_setting.sh BUILD}
SINEW_ALL_COMBINATIONS=1 exec "$build/tests/stepping_tests" --gtest_filter='*/EverySetting.*'
