//! The look of the page.

/// Style sheet. Every colour has a word or a symbol beside it; tables scroll in their own box and never the page.
pub(crate) const CSS: &str = r#"
:root { --ink: #1d2126; --soft: #59616b; --rule: #dfe3e8; --wash: #f6f7f9; --link: #0b5a8f;
  --pass: #00694d; --fail: #b03a00; --amber: #7d5500; --fail-wash: #fdf3ee; --amber-wash: #fdf8ec; }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; scroll-behavior: smooth; }
body { margin: 0; color: var(--ink); background: #fff; font: 400 1rem/1.55 system-ui, -apple-system, "Segoe UI",
  Roboto, "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; overflow-wrap: break-word; }
main { max-width: 84rem; margin: 0 auto; padding: 3rem 1.75rem 4rem; }
h1, h2, h3, h4, h5, h6 { line-height: 1.2; font-weight: 650; letter-spacing: -.012em; margin: 0; text-wrap: balance; }
h1 { font-size: clamp(1.9rem, 4.5vw, 2.7rem); }
h2 { font-size: clamp(1.45rem, 3.2vw, 1.85rem); }
h3 { font-size: 1.08rem; margin: 2.4rem 0 .5rem; }
h4, h5, h6 { font-size: 1rem; margin: 1.5rem 0 .4rem; }
p { margin: .6rem 0; }
a { color: var(--link); text-underline-offset: .16em; text-decoration-thickness: .06em; }
.kicker { margin: 0 0 .45rem; font-size: .84rem; color: var(--soft); letter-spacing: .02em; }
.lead, .claim { max-width: 46rem; font-size: 1.1rem; }
.claim { margin: .9rem 0 1.4rem; }
.note { margin: 0 0 .6rem; color: var(--soft); font-size: .9rem; }
section { margin-top: 4.5rem; padding-top: 2.2rem; border-top: 1px solid var(--rule); }
.pass { --tone: var(--pass); } .fail { --tone: var(--fail); } .amber { --tone: var(--amber); }

.counts { list-style: none; display: flex; flex-wrap: wrap; gap: .9rem 2.1rem; margin: 1.8rem 0; padding: 0; }
.counts b { display: block; font-size: 1.7rem; line-height: 1.15; font-weight: 600; color: var(--tone, var(--ink));
  font-variant-numeric: tabular-nums; }
.counts span { font-size: .84rem; color: var(--tone, var(--soft)); white-space: nowrap; }
.counts .none b, .counts .none span { color: #747c86; font-weight: 400; }
.counts .controls { padding-left: 2.1rem; border-left: 1px solid var(--rule); }

.failing { list-style: none; margin: 1.4rem 0; padding: .7rem 1.1rem; background: var(--fail-wash);
  border-left: 4px solid var(--fail); }
.failing li { padding: .3rem 0 .3rem 1.4rem; text-indent: -1.4rem; font-variant-numeric: tabular-nums; }
.failing li::before { content: "✗"; color: var(--fail); display: inline-block; width: 1.4rem; text-indent: 0;
  font-weight: 700; }
.failing a { color: inherit; text-decoration: none; }
.failing a:hover { text-decoration: underline; }
.failing .more { color: var(--soft); } .failing .more::before { content: ""; }

.scroll { overflow-x: auto; margin: .4rem 0 1rem; }
.scroll:focus-visible, a:focus-visible, summary:focus-visible { outline: 2px solid var(--link); outline-offset: 2px; }
table { border-collapse: separate; border-spacing: 0; width: 100%; font-size: .88rem; line-height: 1.4; }
th, td { padding: .5rem .85rem .5rem 0; text-align: left; vertical-align: top; }
th:last-child, td:last-child { padding-right: .4rem; }
thead th { font-weight: 500; font-size: .91em; color: var(--soft); white-space: nowrap; vertical-align: bottom;
  border-bottom: 1.5px solid var(--ink); }
tbody th { font-weight: 600; }
tbody tr > * { border-bottom: 1px solid var(--rule); }
td.n, th.n { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums lining-nums; }
.rows tbody th { min-width: 10rem; }
.rows td { white-space: nowrap; }
.rows td.wide { white-space: normal; min-width: 15rem; }
.rows td.verdict { white-space: normal; min-width: 10rem; }
.rows tr.fail > * { background: var(--fail-wash); }
.rows tr.amber > * { background: var(--amber-wash); }
.rows tr > :first-child { padding-left: .6rem; border-left: 3px solid transparent; }
.rows thead tr > :first-child { padding-left: calc(.6rem + 3px); border-left: 0; }
.rows tr.fail > :first-child { border-left-color: var(--fail); }
.rows tr.amber > :first-child { border-left-color: var(--amber); }
.fine { display: block; font-size: .9em; color: var(--soft); }
td.n .fine { font-size: .86em; }
.mark { color: var(--tone); font-weight: 600; white-space: nowrap; }
.cases td { min-width: 7rem; }
.cases th .title { display: block; font-weight: 400; color: var(--soft); min-width: 13rem; }
.cases .tally { font-variant-numeric: tabular-nums; margin-right: .6rem; white-space: nowrap; }
.cases .mark { margin-right: .5rem; }
.cases td.fail { color: var(--fail); font-weight: 600; }
.used { display: flex; align-items: center; gap: .6rem; font-variant-numeric: tabular-nums; }
.used b { font-weight: 600; }
.bar { display: inline-block; width: 5.5rem; height: .5rem; background: #e6e9ed; border-right: 2px solid var(--ink); }
.bar i { display: block; height: 100%; background: #5d7f9e; }
.bar i.over { background: var(--fail); }
.what { color: var(--soft); font-size: .95em; }

figure { margin: 2rem 0; max-width: 54rem; }
.plot { overflow-x: auto; }
.plot svg { display: block; width: 100%; height: auto; }
.plot.graph svg { min-width: 34rem; }
figcaption { max-width: 46rem; margin-top: .5rem; font-size: .92rem; color: var(--soft); padding-left: .6rem; }
details { margin: 2.4rem 0 0; }
summary { cursor: pointer; font-size: 1.08rem; font-weight: 650; }
.prose { max-width: 46rem; }
.prose pre { overflow-x: auto; background: var(--wash); padding: .9rem 1.1rem; line-height: 1.5; }
.prose code { font: .9em ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace; }
.prose table { display: block; overflow-x: auto; }
.back { margin: 2rem 0 0; font-size: .88rem; }
dl { margin: 1rem 0 0; font-size: .92rem; }
dl div { display: grid; grid-template-columns: 12rem 1fr; gap: 1rem; padding: .35rem 0; border-bottom: 1px solid var(--rule); }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }

@media (max-width: 40rem) {
  main { padding: 1.6rem 1rem 3rem; }
  section { margin-top: 3rem; padding-top: 1.6rem; }
  .counts { display: grid; grid-template-columns: repeat(3, 1fr); gap: 1rem .5rem; }
  .counts b { font-size: 1.4rem; }
  .counts span { white-space: normal; line-height: 1.25; display: block; }
  .counts .controls { grid-column: 1 / -1; padding: .7rem 0 0; border-left: 0; border-top: 1px solid var(--rule); }
  .lead, .claim { font-size: 1.03rem; }
  /* What a row is about, and how it ended, stay in sight while the rest scrolls. */
  .rows tbody th { position: sticky; left: 0; min-width: 6.5rem; max-width: 8rem; background: #fff; }
  .rows tr.pass th::before { content: "✓ "; color: var(--pass); }
  .rows tr.fail th::before { content: "✗ "; color: var(--fail); }
  .rows tr.amber th::before { content: "▲ "; color: var(--amber); }
  .cases td { min-width: 6rem; } .cases th .title { min-width: 10rem; }
  .failing { padding: .5rem .8rem; font-size: .93rem; }
  dl div { grid-template-columns: 1fr; gap: 0; }
}
@media print {
  @page { size: A4; margin: 13mm; }
  body { font-size: 10pt; } main { max-width: none; padding: 0; }
  section { break-before: page; margin-top: 0; border-top: 0; padding-top: 0; }
  section.provenance { break-before: auto; margin-top: 1.5rem; }
  .scroll, .plot, .prose pre, .prose table { overflow: visible; }
  .prose pre { white-space: pre-wrap; }
  .plot.graph svg { min-width: 0; }
  figure { max-width: 150mm; margin: 4mm 0; break-inside: avoid; }
  table { font-size: 7pt; } h1 { font-size: 22pt; } h2 { font-size: 16pt; }
  .lead, .claim { font-size: 10.5pt; } .failing { font-size: 9pt; padding: 2mm 3mm; margin: 4mm 0; }
  .counts { gap: 3mm 5mm; } .counts .controls { padding-left: 5mm; }
  .counts b { font-size: 14pt; } .counts span { font-size: 8pt; } h3 { margin-top: 7mm; }
  thead { display: table-header-group; }
  tr, .failing li { break-inside: avoid; } h2, h3, .note, summary { break-after: avoid; }
  figcaption, .note { font-size: 9pt; }
  .rows tbody th, .rows td.wide, .rows td.verdict, .cases td, .cases th .title {
    min-width: 0; }
  .rows td { white-space: normal; }
  th, td { padding: 1mm 1.6mm 1mm 0; } thead th { white-space: normal; }
  details::details-content { content-visibility: visible; display: block; height: auto; }
  .back { display: none; } a { color: inherit; text-decoration: none; }
  .failing, .rows tr > *, .bar, .bar i { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
"#;
