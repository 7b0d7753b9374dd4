#include "optimisation/report/page_assets.h"

namespace kingpin::report {

std::string_view GetPageStyle() {
  return R"css(
:root{--ink:#1b1f24;--soft:#59616b;--line:#d5d9de;--pale:#f5f6f8;--accent:#0072B2}
*{box-sizing:border-box}
html{scroll-behavior:smooth;-webkit-print-color-adjust:exact;print-color-adjust:exact}
body{margin:0;color:var(--ink);background:#fff;font:14px/1.5 system-ui,"Segoe UI","Helvetica Neue",Arial,"Liberation Sans","DejaVu Sans",sans-serif}
.layout{display:grid;grid-template-columns:218px minmax(0,1fr);max-width:1480px;margin:0 auto}
nav{position:sticky;top:0;align-self:start;max-height:100vh;overflow:auto;padding:22px 14px 22px 20px;border-right:1px solid var(--line);font-size:12.5px;line-height:1.35}
nav b{display:block;margin-bottom:8px;color:var(--soft);font-weight:600}
nav a{display:block;padding:3px 6px;color:var(--ink);text-decoration:none;border-left:2px solid transparent}
nav a.l3{padding-left:18px;color:var(--soft)}
nav a:hover{background:var(--pale)}
nav a.here{border-left-color:var(--accent);color:var(--accent)}
main{padding:24px 30px 60px;min-width:0}
h1{font-size:25px;line-height:1.2;margin:0 0 2px;font-weight:650}
h2{font-size:19px;margin:42px 0 10px;padding-top:12px;border-top:2px solid var(--ink);font-weight:650}
h3{font-size:15.5px;margin:28px 0 8px;font-weight:650}
h4{font-size:13.5px;margin:18px 0 6px;font-weight:650}
p{margin:6px 0 10px;max-width:92ch}
.sub{color:var(--soft);margin:0 0 14px}
.meta{color:var(--soft);font-size:12.5px}
ul.lead{margin:8px 0 12px;padding-left:20px;max-width:96ch}
ul.lead li{margin:4px 0}
.scroll{overflow-x:auto;margin:8px 0 12px}
table{border-collapse:collapse;font-size:12.8px;font-variant-numeric:tabular-nums lining-nums}
th,td{padding:3.5px 9px;border-bottom:1px solid var(--line);text-align:left;vertical-align:baseline}
thead th{border-bottom:1px solid #8a929b;font-weight:600;vertical-align:bottom}
thead tr:not(:last-child) th{border-bottom:0}
td.n,th.n{text-align:right;white-space:nowrap}
th.c{text-align:center}
th.group,td.group{border-left:1px solid var(--line)}
td.sym,td.b{white-space:nowrap}
sub{line-height:0;font-size:76%}
tr.total td{border-top:1.5px solid var(--ink);font-weight:650}
tr.sep td{border-top:1px solid #8a929b}
.muted{color:var(--soft)}
td.muted{font-size:12px}
.b{font-weight:650}
.mark{font-size:11px;padding-left:3px}
table.wide{width:100%}
.callout{border-left:4px solid #7d8691;background:var(--pale);padding:9px 14px;margin:10px 0;max-width:100ch}
.callout.verdict{border-left-color:var(--accent)}
.callout.warning{border-left-color:#D55E00}
.callout p{margin:2px 0}
.callout ul{margin:2px 0;padding-left:18px}
.callout b.head{display:block}
.charts{display:grid;grid-template-columns:repeat(2,minmax(0,1fr));gap:14px 22px;margin:8px 0 14px}
.charts.three{grid-template-columns:repeat(3,minmax(0,1fr))}
figure.chart{margin:0;min-width:0;position:relative}
figure.single{max-width:760px;margin:8px 0 14px}
figcaption{font-weight:600;font-size:12.8px;margin:0 0 3px}
svg.plot{display:block;width:100%;height:auto;font:11px system-ui,"Segoe UI","Helvetica Neue",Arial,"Liberation Sans","DejaVu Sans",sans-serif;fill:var(--ink);overflow:visible;font-variant-numeric:tabular-nums}
svg.legend{margin:6px 0 2px;max-width:1100px}
svg .g{stroke:#e3e6ea;stroke-width:1}
svg .zero{stroke:#8a929b;stroke-width:1}
svg .frame{fill:none;stroke:#8a929b;stroke-width:1}
svg .ln{fill:none;stroke-linejoin:round}
svg .ref{stroke:#1b1f24;stroke-width:1;stroke-dasharray:3 3}
svg .band{fill:#0072B2;fill-opacity:.12;stroke:none}
svg text.at{fill:#3b424a}
svg text.muted{fill:#59616b}
svg text.small{font-size:10px}
svg text.halo{paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round}
svg .cursor{stroke:#1b1f24;stroke-width:1;pointer-events:none}
.tip{position:absolute;z-index:3;pointer-events:none;background:#fff;border:1px solid #8a929b;font-size:11.5px;line-height:1.35;padding:4px 8px;white-space:nowrap;display:none;font-variant-numeric:tabular-nums;box-shadow:0 1px 4px rgba(0,0,0,.15)}
.tip i{display:inline-block;width:12px;height:3px;vertical-align:middle;margin-right:5px}
.geo svg .body{stroke-linecap:round}
svg .axisline{stroke:#8a929b;stroke-width:.8;stroke-dasharray:9 3 2 3}
svg text.b{font-weight:600}
.controls{display:none;align-items:center;gap:10px;font-size:12.5px;margin:6px 0;flex-wrap:wrap}
.js .controls{display:flex}
.controls input[type=range]{width:220px}
.controls button{font:inherit;padding:2px 12px;min-width:74px}
.controls output{min-width:250px;font-variant-numeric:tabular-nums}
details{border:1px solid var(--line);margin:6px 0;padding:0 12px}
details>summary{cursor:pointer;padding:6px 0;font-weight:600;font-size:13px}
details .scroll{margin-top:0}
dl{display:grid;grid-template-columns:minmax(140px,max-content) minmax(0,1fr);gap:4px 18px;font-size:13px;margin:6px 0 12px;max-width:120ch}
dt{font-weight:600}
dd{margin:0}
code{font:12px ui-monospace,"DejaVu Sans Mono",Menlo,Consolas,monospace}
p code,dd code,td.hash code{overflow-wrap:anywhere}
table.parameters td:first-child{white-space:nowrap}
table.parameters td.muted{overflow-wrap:anywhere}
@media screen and (max-width:1120px){.layout{display:block}nav{position:static;max-height:none;border-right:0;border-bottom:1px solid var(--line);columns:3}main{padding:18px}}
@media screen and (max-width:760px){.charts,.charts.three{grid-template-columns:1fr}nav{columns:1}}
@page{size:A4 landscape;margin:12mm 13mm}
@media print{
body{font-size:7.6pt;line-height:1.3}
.layout{display:block;max-width:none}
nav,.controls,.tip{display:none!important}
main{padding:0}
h1{font-size:15pt}
h2{font-size:12.5pt;margin-top:14px;padding-top:6px}
h3{font-size:9.6pt;margin:9px 0 3px}
h4{font-size:8.2pt;margin:7px 0 2px}
p{margin:2px 0 4px}
h2,h3,h4,figcaption,summary{break-after:avoid}
figure,tr,.callout,svg{break-inside:avoid}
thead{display:table-header-group}
.scroll{overflow:visible;margin:3px 0 5px}
.meta{font-size:6.7pt}
svg.top{max-height:62mm}
svg.legend{max-width:150mm}
.charts{grid-template-columns:repeat(4,minmax(0,1fr));gap:5px 12px;margin:3px 0 5px}
.charts.three{grid-template-columns:repeat(6,minmax(0,1fr));gap:5px 8px}
.charts svg.plot{font-size:13.5px}
main>figure.chart,figure.single{max-width:150mm}
figure.chart{font-size:7pt}
figcaption{font-size:7pt}
.callout{padding:4px 9px;margin:4px 0;max-width:none}
details{border:0;padding:0;margin:3px 0}
details>summary{list-style:none;padding:2px 0;font-size:7.6pt}
details::details-content{content-visibility:visible;block-size:auto}
dl{font-size:7.2pt;gap:1px 12px;max-width:none}
table{font-size:6.7pt}
td.muted{font-size:6.5pt}
code{font-size:6.3pt}
th,td{padding:1px 5px}
.parameters-list{columns:2;column-gap:8mm}
.parameters-list .scroll{break-inside:auto}
table.parameters{font-size:5.9pt}
table.parameters td.muted{font-size:5.7pt}
table.parameters code{font-size:5.7pt}
}
)css";
}

}  // namespace kingpin::report
