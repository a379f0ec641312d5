# What all figures share: colours, type, tics. Stands at the beginning of every script that
# scenes/plot writes. Expects `width` and `height`, pixels of the SVG.
set encoding utf8
set micro
ink = 0x222222
muted = 0x6e6e6e
band = 0xe3e3e3
paper = 0xfefefe
# The commands that begin a drawing as SVG and as PNG of twice the size.
svg = sprintf('set terminal svg size %d,%d noenhanced font "sans-serif,14" background "#fefefe" rounded', width, height)
png = sprintf('set terminal pngcairo size %d,%d noenhanced font "DejaVu Sans,12" fontscale 1.7 linewidth 2 pointscale 2 background "#ffffff" rounded', 2 * width, 2 * height)
set key above left horizontal Left reverse samplen 1.5 textcolor rgb ink
set samples 2
set border 3 linecolor rgb ink linewidth 1
set tics nomirror textcolor rgb ink scale 0.6,0.3
set title textcolor rgb ink offset 0,-0.6
set xlabel textcolor rgb ink offset 0,0.4
set ylabel textcolor rgb ink offset -0.2,0
set grid xtics ytics linetype 1 linecolor rgb "#d8d8d8" linewidth 1
set grid back
set errorbars 0
set lmargin 11
set rmargin 3

# How each mark of scenes/plot/plot.h is drawn; a colour follows.
line = "using 1:2 with lines linewidth 1.6"
dashed = "using 1:2 with lines dashtype 2 linewidth 1.6"
curve = "using 1:2 with linespoints pointtype 7 pointsize 0.6 linewidth 1.3"
hollow_curve = "using 1:2 with linespoints pointtype 6 pointsize 0.6 linewidth 1.3 dashtype 3"
bars = "using 1:2:3:4:5:6 with xyerrorbars pointtype 7 pointsize 0.8 linewidth 1.3"
hollow_bars = "using 1:2:3:4:5:6 with xyerrorbars pointtype 6 pointsize 0.8 linewidth 1.3"
square_bars = "using 1:2:3:4:5:6 with xyerrorbars pointtype 5 pointsize 0.8 linewidth 1.3"
up = "using 1:2 with points pointtype 9 pointsize 0.6"
down = "using 1:2 with points pointtype 11 pointsize 0.6"
area = "using 1:5:6 with filledcurves fillcolor rgb band fillstyle solid noborder"
