// The track as seen from its side: its angle to the dashed level is alpha. Its length on the screen is the same at each alpha, and
// fits the image at the steepest.
const STEEPEST = 8 * Math.PI / 180;
function trackLength(width, height, em) {
  return Math.min(width - 9 * em, (height - 4.2 * em) / Math.sin(STEEPEST));
}
function drawTrack(here, points, p) {
  const s = sheet('track'), { c, width, height, em } = s, xs = points.map(q => q.x);
  if (!$('lock').checked || !spans.track) spans.track = [Math.min(...xs, 0), Math.max(...xs, 0.01)];
  const [low, high] = spans.track, slope = p.alpha * Math.PI / 180, half = trackLength(width, height, em) / 2;
  const px = x => -half + 2 * em + (2 * half - 4 * em) * (x - low) / (high - low);
  c.translate(width / 2, height / 2 + 0.5 * em);
  // The wedge below the track, from its lower end, with the angle.
  const side = slope < 0 ? -1 : 1, foot = [side * half * Math.cos(slope), side * half * Math.sin(slope) + 0.7 * em];
  c.strokeStyle = s.color('soft'); c.lineWidth = 1; c.setLineDash([4, 4]); c.beginPath();
  c.moveTo(...foot); c.lineTo(-foot[0], foot[1]); c.stroke(); c.setLineDash([]);
  c.fillStyle = s.color('ink'); c.textBaseline = 'middle'; c.textAlign = side > 0 ? 'left' : 'right';
  c.fillText('α = ' + show(p.alpha, 1) + '°', foot[0] + side * 0.6 * em, foot[1]);
  c.rotate(slope);
  c.fillStyle = s.color('track'); c.fillRect(-half, 0.5 * em, 2 * half, 0.4 * em);
  if (low <= 0 && 0 <= high) { c.fillStyle = s.color('soft'); c.textAlign = 'center'; c.textBaseline = 'alphabetic'; c.fillText('0', px(0), 1.9 * em); }
  if (here.x < low - 1e-9 || here.x > high + 1e-9) return;  // beyond the locked track
  c.fillStyle = s.color('first'); c.fillRect(px(here.x) - 1.8 * em, -em, 3.6 * em, 1.4 * em);
  c.fillStyle = s.color('paper'); c.beginPath(); c.arc(px(here.x), -0.3 * em, 0.4 * em, 0, 7); c.fill();
  if (Math.abs(here.v) <= 1e-4) return;
  const d = Math.sign(here.v), l = (1 + 2.2 * Math.min(1, Math.abs(here.v))) * em, y = -1.6 * em, from = px(here.x), to = from + d * l;
  c.strokeStyle = c.fillStyle = s.color('third'); c.lineWidth = 0.2 * em;
  c.beginPath(); c.moveTo(from, y); c.lineTo(to, y); c.stroke();
  c.beginPath(); c.moveTo(to + d * 0.6 * em, y); c.lineTo(to, y - 0.4 * em); c.lineTo(to, y + 0.4 * em); c.fill();
}
