#include "teach/page/explorer_script.h"

namespace glidelab::teach {

// Text grows with the window, so that a projected page is read from the last row; plots fill what height is left
// (fit() in explorer_view.cpp measures it).
const std::string_view kExplorerBody = R"html(<style>
:root { --first: #0072b2; --second: #d55e00; --third: #00795b; font-size: clamp(16px, 1.9vmin, 30px); }
@media (prefers-color-scheme: dark) { :root { --first: #6cb8ea; --second: #ff9a57; --third: #4fd0a8; } }
body { font-size: 1rem; line-height: 1.4; }
main { max-width: none; padding-top: .3rem; }
h1 { font-size: 1.35rem; margin: .2rem 0; }
#explorer { display: grid; gap: .4rem; }
#explorer p { max-width: none; margin: 0; }
#controls { display: grid; grid-template-columns: repeat(5, minmax(0, 1fr)); gap: .3rem 1.2rem; }
#controls .line { display: flex; justify-content: space-between; gap: .5rem; }
#explorer output { font-variant-numeric: tabular-nums; font-weight: 600; }
#explorer input[type=range] { width: 100%; margin: .1rem 0 0; accent-color: var(--accent); }
#explorer select, #explorer button { font: inherit; padding: .1rem .6rem; color: inherit; background: var(--tint);
  border: 1px solid var(--line); border-radius: 6px; }
#controls select { width: 100%; }
#explorer button { cursor: pointer; }
#cases { grid-column: 1 / -1; display: flex; flex-wrap: wrap; gap: .3rem; align-items: baseline; }
#explorer :focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
#plots { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: .5rem; }
#plots figure { max-width: none; background: var(--paper); }
#plots figcaption { padding: .1rem .6rem .2rem; line-height: 1.25; }
#plots .wide { grid-column: 1 / -1; }
#plots canvas { display: block; width: 100%; height: var(--plot, max(11rem, 100vh - 24.5rem)); }
#plots canvas#track { height: 5.6rem; }
#readout { font-variant-numeric: tabular-nums; min-height: 3.6em; padding: .2rem .7rem; }
#timebar { position: sticky; bottom: 0; display: flex; gap: .8rem; align-items: center; padding: .35rem 0;
  background: var(--paper); border-top: 1px solid var(--line); }
#timebar button { min-width: 5.2em; }
#timebar label { flex: 1; display: flex; gap: .7rem; align-items: center; white-space: nowrap; }
#timebar output { min-width: 3em; }
@media (max-width: 900px) { #controls { grid-template-columns: repeat(auto-fit, minmax(min(15rem, 100%), 1fr)); } }
@media (max-width: 600px) {  /* a telephone: sliders and all three plots in one view, the words below it */
  #controls { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: .1rem .9rem; }
  #controls label:first-child { grid-column: 1 / -1; display: flex; gap: .6rem; align-items: center; }
  #cases { flex-wrap: nowrap; overflow-x: auto; white-space: nowrap; }
  #plots { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: .35rem; }
  #plots figure:last-child { grid-column: 1 / -1; }
  #plots canvas { height: var(--plot, 9rem); }
  #plots canvas#track { height: 5.2rem; }
  #plots figcaption { font-size: .8rem; padding: 0 .4rem .1rem; }
  #timebar { gap: .5rem; }
}
@media print {  /* as drawn for the screen, only smaller or larger */
  #explorer button, #explorer input, #cases { display: none; }
  #plots { grid-template-columns: repeat(3, minmax(0, 1fr)); }
  #plots figure:last-child { grid-column: auto; }
  #plots canvas, #plots canvas#track { height: auto; }
}
</style>
<h1>Friction in the phase plane</h1>
<div id="explorer">
<form id="controls" onsubmit="return false">
<label>Drag<select id="law"><option value="0">viscous: K v</option><option value="1">C v |v|^½ (power 3/2)</option>
<option value="2">quadratic: C v |v|</option><option value="3">none</option></select></label>
<label><span class="line"><span id="dragname">K/m (1/s)</span><output id="o-k"></output></span>
<input type="range" id="k" min="0" max="5" step="0.01" value="2.77"></label>
<label><span class="line"><span>friction μ</span><output id="o-mu"></output></span>
<input type="range" id="mu" min="0" max="0.03" step="0.0001" value="0.0071"></label>
<label><span class="line"><span>inclination α (°)</span><output id="o-alpha"></output></span>
<input type="range" id="alpha" min="-4" max="8" step="0.1" value="4.3"></label>
<label><span class="line"><span>start v₀ (m/s)</span><output id="o-v0"></output></span>
<input type="range" id="v0" min="-2" max="2" step="0.01" value="-1.2"></label>
<p id="cases" class="soft">Cases of the paper:
<button type="button" data-case="0,2.88,0,0,1.2">level, viscous</button>
<button type="button" data-case="0,2.77,0,4.3,0">slope, viscous</button>
<button type="button" data-case="3,0,0.03,0,0.8">level, Coulomb</button>
<button type="button" data-case="3,0,0.03,4,-1.4">slope, Coulomb</button>
<button type="button" data-case="0,2.88,0.0075,0,-1.2">level, both</button>
<button type="button" data-case="0,2.77,0.0071,4.3,-1.2">slope, both</button>
<button type="button" data-case="0,1,0.03,1.5,-1.2">up, and it stays</button></p>
</form>
<div id="plots">
<figure class="wide"><canvas id="track" role="img" aria-label="the glider on its track"></canvas></figure>
<figure><canvas id="xt" role="img" aria-label="position over time"></canvas><figcaption>x(t), downhill upwards</figcaption></figure>
<figure><canvas id="vt" role="img" aria-label="velocity over time"></canvas><figcaption>v(t); dashed: the limit</figcaption></figure>
<figure><canvas id="av" role="img" aria-label="acceleration over velocity"></canvas><figcaption>a(v); thin: the law, dot on the
axis: equilibrium</figcaption></figure>
</div>
<p id="readout" class="note" aria-live="polite"></p>
<div id="timebar"><button type="button" id="play">Play</button><label>t (s)
<input type="range" id="t" min="0" max="5" step="0.01" value="1"><output id="o-t"></output></label></div>
</div>
<p>A glider on a track, x positive downhill: m dv/dt = m g sin α − drag(v) − sign(v) μ m g cos α. Choose the law, its strength, the
slope and the push; the point runs along x(t), v(t) and a(v) together. On the keyboard: Tab to a slider, then the arrow keys.</p>
<p class="soft" id="measured"></p>
)html";

}  // namespace glidelab::teach
