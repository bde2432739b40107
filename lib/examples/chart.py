# SPDX-License-Identifier: GPL-3.0-or-later
"""chart.py RUN CHART.png: the error of a run's volume over time, as a chart."""
import sys

import matplotlib.pyplot as plt
import sinew

run, picture = sys.argv[1:]
metrics = sinew.measure(run)
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.plot(metrics["time"], 100 * metrics["volume_error"])
axes.set(xlabel="time (s)", ylabel="error of the volume (%)")
axes.grid(alpha=0.3)
figure.savefig(picture, dpi=150)
