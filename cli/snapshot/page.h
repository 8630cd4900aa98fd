// What is the same in every report.html: the page, its style and its script.
#pragma once

namespace cli {

inline constexpr const char* kPage = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Snapshots: {folder}</title>
<style>{style}</style>
</head>
<body>
<header><h1>{verdict} {folder}</h1><p>{counts}; crashreel {version}, {seconds:.1f} s</p></header>
<main>
{sections}</main>
<script>{script}</script>
</body>
</html>
)";

inline constexpr const char* kStyle = R"(
body { font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; margin: 0; color: #1b1f24; background: #f3f4f6; }
header { background: #1f2933; color: #fff; padding: 18px 28px; }
header h1 { font-size: 20px; margin: 0 0 4px; }
header p { margin: 0; color: #cbd5e1; }
main { padding: 8px 28px 40px; max-width: 1240px; }
section { background: #fff; border: 1px solid #d8dde3; border-radius: 6px; padding: 14px 18px; margin: 16px 0; }
h2 { font-size: 16px; margin: 0 0 4px; }
h3 { font-size: 15px; margin: 14px 0 6px; }
a { color: #1d5fa8; }
.verdict { display: inline-block; border-radius: 3px; padding: 0 7px; font-size: 13px; color: #fff; background: #b3261e; }
.verdict.same, .verdict.updated { background: #2e7d32; }
.verdict.new { background: #1d5fa8; }
.verdict.missing, .verdict.orphaned { background: #9a6700; }
.row { display: flex; flex-wrap: wrap; gap: 12px; margin-bottom: 8px; }
figure { margin: 0; width: 384px; }
figure img { display: block; width: 100%; border: 1px solid #9aa5b1; box-sizing: border-box; cursor: zoom-in; }
figure.large { width: 100%; }
figure.large img { cursor: zoom-out; image-rendering: pixelated; }
figcaption { font-size: 13px; color: #52606d; padding-top: 3px; }
.stack { position: relative; }
.stack .over { position: absolute; left: 0; top: 0; }
.controls { display: flex; gap: 8px; align-items: center; font-size: 13px; color: #52606d; margin-top: 4px; }
.controls input { flex: 1; }
table { border-collapse: collapse; margin: 8px 0; font-size: 13px; }
td, th { border-bottom: 1px solid #e2e6ea; padding: 2px 14px 2px 0; text-align: left; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
tr.beyond td { color: #b3261e; font-weight: 600; }
pre { background: #fdf0ef; padding: 8px; white-space: pre-wrap; }
ul { margin: 8px 0 0; padding-left: 20px; columns: 3 300px; font-size: 13px; }
)";

// The slider fades the actual picture over the expected one; blinking takes one, then the other, twice a second. Both are taken
// from the row above, so that the page holds them once.
inline constexpr const char* kScript = R"(
for (const box of document.querySelectorAll('.picture')) {
  const stack = box.querySelector('.stack'), slider = box.querySelector('input'), button = box.querySelector('button');
  if (!stack) continue;
  stack.append(box.querySelector('.expected').cloneNode());
  const over = box.querySelector('.actual').cloneNode();
  over.classList.add('over');
  stack.append(over);
  let timer = 0;
  const show = value => { over.style.opacity = value / 100; };
  const stop = () => { clearInterval(timer); timer = 0; button.textContent = 'blink'; };
  slider.addEventListener('input', () => { stop(); show(slider.value); });
  button.addEventListener('click', () => {
    if (timer) { stop(); show(slider.value); return; }
    let on = false;
    button.textContent = 'stop';
    timer = setInterval(() => { on = !on; show(on ? 100 : 0); }, 250);
  });
  show(slider.value);
}
for (const picture of document.querySelectorAll('figure img'))
  picture.addEventListener('click', () => picture.closest('figure').classList.toggle('large'));
)";

// one picture over the other; the script above fills it
inline constexpr const char* kFader =
    "<div class=\"stack\"></div><div class=\"controls\">expected <input type=\"range\" min=\"0\" max=\"100\" value=\"50\" "
    "aria-label=\"fade\"> actual <button type=\"button\">blink</button></div>";

}  // namespace cli
