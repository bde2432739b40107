// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/report_style.h"

namespace sinew {

std::string_view report_style() {
  return R"css(
:root {
  color-scheme: light dark;
  --page: #fbfaf8; --card: #ffffff; --ink: #22262b; --quiet: #626970; --rule: #e4e2dd;
  --good: #2c7a4b; --fair: #a1660b; --poor: #b3363f;
  --c1: #2a6fb3; --c2: #c2571a; --c3: #2e8b57; --c4: #8a4fb0; --c5: #b03a56; --c6: #6b7280;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #16181b; --card: #1e2125; --ink: #e4e6e8; --quiet: #9aa1a9; --rule: #33383e;
    --good: #6cc492; --fair: #e0aa55; --poor: #f08088;
    --c1: #6aaeea; --c2: #f0975a; --c3: #62c58e; --c4: #c397e6; --c5: #ef7f97; --c6: #a5adba;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 2.5rem 1.5rem 4rem; max-width: 76rem; background: var(--page);
  color: var(--ink); font: 1rem/1.5 system-ui, "Segoe UI", "Noto Sans", sans-serif;
}
h1 { margin: 0; font-size: 2rem; line-height: 1.2; font-weight: 650; overflow-wrap: anywhere; }
h2 { margin: 3rem 0 1rem; font-size: 1.25rem; font-weight: 650; }
h3 { margin: 0; font-size: 1rem; font-weight: 600; }
p { margin: 0.25rem 0; }
.quiet, figcaption p, footer, .unit { color: var(--quiet); }
.unit { font-weight: 400; }
code, pre { font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: 0.85em; }
.cards, .charts, .pictures, .facts { display: grid; gap: 1rem; }
.cards { grid-template-columns: repeat(auto-fit, minmax(12.5rem, 1fr)); margin-top: 2rem; }
.charts, .pictures { grid-template-columns: repeat(auto-fill, minmax(min(100%, 28rem), 1fr)); }
.facts { grid-template-columns: repeat(auto-fit, minmax(min(100%, 22rem), 1fr)); }
.card, figure, .facts section, table, details {
  margin: 0; background: var(--card); border: 1px solid var(--rule); border-radius: 0.6rem;
}
.card { padding: 1rem 1.1rem; display: flex; flex-direction: column; }
.card b { font-size: 1.7rem; font-weight: 600; line-height: 1.3; }
.card .label { color: var(--quiet); font-size: 0.9rem; flex: 1; line-height: 1.35; }
.card .word { margin-top: 0.5rem; font-size: 0.95rem; font-weight: 600; }
.word::before { content: "●\00a0"; }
.good { color: var(--good); } .fair { color: var(--fair); } .poor { color: var(--poor); }
.unknown { color: var(--quiet); }
figure { padding: 1rem 1.1rem; overflow: hidden; }
figcaption p { font-size: 0.9rem; }
.chart { display: flex; flex-direction: column; justify-content: space-between; }
.legend { display: flex; flex-wrap: wrap; gap: 0 1.1rem; margin: 0.3rem 0 0.4rem; }
.legend span { white-space: nowrap; }
.legend i {
  display: inline-block; width: 1.1rem; vertical-align: middle; margin-right: 0.4rem;
  border-top: 0.19rem solid;
}
i.c1 { border-color: var(--c1); } i.c2 { border-color: var(--c2); } i.c3 { border-color: var(--c3); }
i.c4 { border-color: var(--c4); } i.c5 { border-color: var(--c5); } i.c6 { border-color: var(--c6); }
i.c4, i.c5, i.c6 { border-top-style: dashed; }
svg { display: block; width: 100%; height: auto; }
svg text { fill: var(--quiet); font-size: 9.5px; }
svg .end { text-anchor: end; } svg .middle { text-anchor: middle; }
svg path { fill: none; }
.grid { stroke: var(--rule); } .zero { stroke: var(--quiet); stroke-opacity: 0.6; }
svg .bone { fill: var(--quiet); fill-opacity: 0.22; }
.line { stroke-width: 1.8; stroke-linejoin: round; stroke-linecap: round; }
.line.c1 { stroke: var(--c1); } .line.c2 { stroke: var(--c2); } .line.c3 { stroke: var(--c3); }
.line.c4 { stroke: var(--c4); stroke-dasharray: 7 4; }
.line.c5 { stroke: var(--c5); stroke-dasharray: 2 4; }
.line.c6 { stroke: var(--c6); stroke-dasharray: 9 3 2 3; }
img, video { display: block; width: 100%; height: auto; border-radius: 0.3rem; }
.pictures figcaption { margin-top: 0.6rem; font-size: 0.9rem; color: var(--quiet); }
table { width: 100%; border-collapse: separate; border-spacing: 0; overflow: hidden; }
th { text-align: left; font-size: 0.85rem; font-weight: 600; color: var(--quiet); }
th, td { padding: 0.5rem 0.8rem; vertical-align: top; }
tr + tr td, tbody tr:first-child td { border-top: 1px solid var(--rule); }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td small { display: block; color: var(--quiet); font-size: 0.85rem; line-height: 1.4; }
.facts section { padding: 1rem 1.1rem; }
dl { display: grid; grid-template-columns: auto 1fr; gap: 0.2rem 1.2rem; margin: 0.5rem 0 0; }
dt { color: var(--quiet); }
dd { margin: 0; text-align: right; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
details { margin-top: 1rem; padding: 0.8rem 1.1rem; }
summary { cursor: pointer; font-weight: 600; }
pre { overflow-x: auto; line-height: 1.45; }
footer { margin-top: 3rem; font-size: 0.9rem; }
@media (max-width: 44rem) {
  body { padding: 1.5rem 0.9rem 3rem; }
  h1 { font-size: 1.6rem; }
  .cards { grid-template-columns: 1fr 1fr; gap: 0.7rem; }
  .card { padding: 0.8rem 0.9rem; }
  .card:last-child:nth-child(odd) { grid-column: 1 / -1; }
  .card b { font-size: 1.4rem; }
  figure { padding: 0.8rem; }
  svg text { font-size: 12.5px; }
  thead { display: none; }
  tr { display: grid; grid-template-columns: 1fr 1fr; padding: 0.6rem 0.3rem; }
  tbody tr + tr { border-top: 1px solid var(--rule); }
  tbody tr td, tbody tr:first-child td { border: 0; padding: 0.1rem 0.6rem; }
  td:first-child { grid-column: 1 / -1; padding-bottom: 0.3rem; }
  td[data-label]::before { content: attr(data-label); float: left; color: var(--quiet); }
  td:nth-child(even):last-child { grid-column: 1 / -1; }
}
@media print { body { max-width: none; padding: 0; } figure, .card, tr { break-inside: avoid; } }
)css";
}

}  // namespace sinew
