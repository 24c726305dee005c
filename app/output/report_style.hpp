// How the page of `hamgen report` looks.
#pragma once

#include <string_view>

namespace hamgen::app {

// Pictures have colours of their own for dark paper; see with_dark_form.
inline constexpr std::string_view kReportStyle = R"(
:root { color-scheme: light dark; --ink: #1d1d1f; --soft: #5f5e5a; --paper: #fff; --line: #e2e0da;
  --tint: #f6f5f1; --accent: #0072b2; --good: #1a6b3c; --bad: #a8321b; --open: #8a5a00;
  --plain: #4a5568; --shade: #0004; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e4df; --soft: #a5a29a; --paper: #17181a;
  --line: #35373b; --tint: #202225; --accent: #5ab2ec; --good: #74c796; --bad: #f0907a;
  --open: #e0b95c; --plain: #9fb0c8; --shade: #fff4; } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 17px/1.55 'Iowan Old Style', 'Palatino Linotype', Palatino, 'TeX Gyre Pagella', P052,
  'URW Palladio L', 'Book Antiqua', Georgia, serif; }
main { max-width: 66rem; margin: 0 auto; padding: 3rem 1.25rem 4rem; }
h1 { font-size: 2.3rem; font-weight: 600; margin: 0; line-height: 1.15; letter-spacing: -.01em;
  overflow-wrap: anywhere; }
h2 { font-size: 1.3rem; font-weight: 600; margin: 3.2rem 0 .8rem; line-height: 1.25; }
p, ul { max-width: 44rem; margin: .7rem 0; }
.lead, .origin, figcaption, .note { color: var(--soft); }
.origin { margin: .2rem 0 0; font-size: .88rem; }
.note, figcaption { font-size: .88rem; line-height: 1.45; }
.answers { margin: 1.8rem 0 0; padding: .3rem 1.2rem; background: var(--tint);
  border-left: 3px solid var(--accent); }
.answers div { display: grid; grid-template-columns: 10.5rem 1fr; gap: .1rem 1rem; padding: .5rem 0; }
.answers div + div { border-top: 1px solid var(--line); }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; min-width: 0; }
.answers strong { font-weight: 600; }
.wide, .formula { overflow-x: auto; max-width: 100%;
  background: linear-gradient(to right, var(--paper) 30%, transparent) left / 3rem 100%,
    linear-gradient(to left, var(--paper) 30%, transparent) right / 3rem 100%,
    linear-gradient(to right, var(--shade), transparent) left / .6rem 100%,
    linear-gradient(to left, var(--shade), transparent) right / .6rem 100%;
  background-repeat: no-repeat; background-attachment: local, local, scroll, scroll; }
math { font-family: Formula, 'TeX Gyre Pagella Math', 'Latin Modern Math', 'Cambria Math', math;
  font-size: 1.04em; }
.formula { overflow-y: hidden; padding: .4rem 0 .4rem 1.5rem; text-indent: -1.5rem;
  line-height: 2.1; }
.formula math { font-size: 1.12em; text-indent: 0; }
.value { white-space: nowrap; }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums;
  margin: .6rem 0; }
th, td { padding: .28rem 1.1rem .28rem 0; text-align: left; vertical-align: top; }
th { font-weight: 600; border-bottom: 1px solid var(--soft); white-space: nowrap; }
td { border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; white-space: nowrap; }
td.name { white-space: nowrap; }
td.detail { color: var(--soft); min-width: 16rem; }
tr.front td { font-weight: 600; }
.verdict { font-size: .84em; white-space: nowrap; font-weight: 600; }
.proved { color: var(--good); } .refuted { color: var(--bad); } .open { color: var(--open); }
.tested { color: var(--accent); } .verdict.measured { color: var(--plain); font-weight: 400; }
.figures { display: grid; gap: 2rem 2.2rem;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 21rem), 1fr)); }
.figures .large { grid-column: 1 / -1; }
figure { margin: 1rem 0 0; min-width: 0; }
.figures figure { margin: 0; }
figure img { display: block; width: 100%; height: auto; }
figcaption { margin-top: .5rem; max-width: 44rem; }
details { margin: .8rem 0; }
summary { cursor: pointer; color: var(--accent); width: fit-content; }
summary math { color: inherit; }
pre { background: var(--tint); padding: .9rem 1.1rem; overflow-x: auto; margin: .6rem 0;
  font: .78rem/1.5 'DejaVu Sans Mono', Menlo, Consolas, monospace; }
code { font-family: 'DejaVu Sans Mono', Menlo, Consolas, monospace; font-size: .82em;
  overflow-wrap: anywhere; }
.command span { display: inline-block; max-width: 100%; }
sup { line-height: 0; font-size: .72em; }
footer { font-size: .88rem; color: var(--soft); }
footer h2 { font-size: 1.05rem; }
footer dl { margin: 0; } footer dl div { display: grid; grid-template-columns: 6rem 1fr; gap: 1rem; }
@media (max-width: 44rem) { main { padding-top: 1.8rem; } h1 { font-size: 1.9rem; }
  .answers div { grid-template-columns: 1fr; }
  td.name { white-space: normal; overflow-wrap: anywhere; } th, td { padding-right: .7rem; } }
@media print { body { font-size: 10.5pt; } main { padding: 0; max-width: none; }
  figure { break-inside: avoid; } h2 { break-after: avoid; } }
)";

}  // namespace hamgen::app
