# What all figures of a report share. Expects `width` and `height`, pixels of the SVG.
set encoding utf8
set datafile separator comma
set datafile columnheaders
ink = "#222222"
muted = "#6e6e6e"
grid = "#d8d8d8"
minor = "#ececec"
band = "#e3e3e3"
paper = "#fefefe"
green = "#009E73"
blue = "#0072B2"
vermilion = "#D55E00"
media = "svg png"
# The command that begins a drawing.
open(medium, name) = medium eq "svg" ? \
  sprintf('set terminal svg size %d,%d font "sans-serif,15" background "%s" rounded; set output "%s.svg"', \
          width, height, paper, name) : \
  sprintf('set terminal pngcairo size %d,%d font "DejaVu Sans,13" fontscale 1.7 linewidth 2 pointscale 2 background "#ffffff" rounded; set output "%s.png"', \
          2 * width, 2 * height, name)
# In here, since gnuplot takes a # in a block for a comment.
hexadecimal(colour) = sprintf("#%06x", int(colour))
# Distance of tics up to `high`, 1, 2 or 5 times a power of ten, for some `count` of them.
tic_step(high, count) = (raw = (high > 0 ? high : 1.0) / count, decade = 10 ** floor(log10(raw)), \
  raw / decade < 1.5 ? decade : raw / decade < 3.5 ? 2 * decade : raw / decade < 7.5 ? 5 * decade : 10 * decade)
set key off
set samples 200
set border 3 linecolor rgb ink linewidth 1
set tics nomirror textcolor rgb ink scale 0.6,0.3
set xlabel textcolor rgb ink offset 0,0.3
set ylabel textcolor rgb ink
set grid xtics ytics mxtics mytics linetype 1 linecolor rgb grid linewidth 1, linetype 1 linecolor rgb minor linewidth 1
set grid back
set errorbars 0
