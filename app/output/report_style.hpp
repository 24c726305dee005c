// How the page of `hamgen report` looks.
#pragma once

#include <string_view>

namespace hamgen::app {

// Pictures stand on white paper, in the dark too: their colours were chosen for it.
inline constexpr std::string_view kReportStyle = R"(
:root { color-scheme: light dark; --ink: #1b1b1b; --soft: #5c5c5c; --paper: #fdfdfb;
  --line: #d9d8d2; --tint: #f3f2ec; --good: #1a6b3c; --bad: #a8321b; --open: #7a5b00; --shade: #0005; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e4df; --soft: #a5a29a; --paper: #17181a;
  --line: #3a3b3e; --tint: #222427; --good: #74c796; --bad: #f0907a; --open: #d9b95b; --shade: #fff5; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); line-height: 1.5;
  font: 17px/1.5 Charter, 'Bitstream Charter', 'Source Serif Pro', Cambria, Georgia, serif; }
main { max-width: 68rem; margin: 0 auto; padding: 2.5rem 1.25rem 4rem; }
h1 { font-size: 2.1rem; font-weight: 600; margin: 0 0 .25rem; line-height: 1.15; }
h2 { font-size: 1.25rem; font-weight: 600; margin: 2.75rem 0 .75rem; padding-top: .6rem;
  border-top: 1px solid var(--line); }
p, ul, dl { max-width: 42rem; }
.lead, figcaption, .note { color: var(--soft); }
.note, figcaption { font-size: .88rem; }
.wide, .picture { overflow-x: auto; max-width: 100%;
  background: linear-gradient(to right, var(--paper) 30%, transparent) left / 3rem 100%,
    linear-gradient(to left, var(--paper) 30%, transparent) right / 3rem 100%,
    linear-gradient(to right, var(--shade), transparent) left / 1rem 100%,
    linear-gradient(to left, var(--shade), transparent) right / 1rem 100%;
  background-repeat: no-repeat; background-attachment: local, local, scroll, scroll; }
.more { display: none; }
.formula { padding: .35rem 0; }
math { font-size: 1.12em; }
table { border-collapse: collapse; font-size: .88rem; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .9rem .25rem 0; text-align: left; vertical-align: top; }
th { font-weight: 600; border-bottom: 1px solid var(--ink); white-space: nowrap; }
td { border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; white-space: nowrap; }
td.name { white-space: nowrap; }
tr.front td { font-weight: 600; }
.proved { color: var(--good); } .refuted { color: var(--bad); } .open { color: var(--open); }
.proved, .refuted, .open { white-space: nowrap; font-weight: 600; }
.figures { display: grid; gap: 1.75rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 29rem), 1fr)); }
figure { margin: 0; }
figure img { display: block; width: 100%; height: auto; background: #fff; border: 1px solid var(--line);
  border-radius: 4px; padding: .25rem; }
figcaption { margin-top: .4rem; }
pre { background: var(--tint); border: 1px solid var(--line); border-radius: 4px; padding: .8rem 1rem;
  overflow-x: auto; font: .78rem/1.45 'DejaVu Sans Mono', Menlo, Consolas, monospace; }
code { font-family: 'DejaVu Sans Mono', Menlo, Consolas, monospace; font-size: .85em;
  overflow-wrap: anywhere; }
summary { cursor: pointer; }
/* Below this a picture would have letters of less than 11 pixels: it is scrolled instead, and so is a
   table, both with a line that says so. */
@media (max-width: 40rem) { .picture img { width: 36rem; max-width: none; }
  .more { display: block; color: var(--soft); font-size: .8rem; margin: .2rem 0; } }
@media print { .more { display: none; } body { font-size: 11pt; } main { padding: 0; max-width: none; } figure { break-inside: avoid; } }
)";

}  // namespace hamgen::app
