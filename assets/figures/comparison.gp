# The README's picture: measured and rendered force over some seconds, and the
# error against what a hand can notice.
#   gnuplot -c assets/figures/comparison.gp FORCES.csv OUT.png [FROM_S TO_S]
# FORCES.csv as written by scenes/run.sh (build/run/forces.csv).
forces = ARG1
from = ARGC > 2 ? real(ARG3) : 20
to = ARGC > 3 ? real(ARG4) : 28
set terminal pngcairo size 1200,660 font "DejaVu Sans,15" background "#ffffff" rounded
set output ARG2
set datafile separator ","
set key off
set xrange [from:to]
set border 3 linecolor "#444444"
set tics nomirror textcolor "#444444"
set grid ytics linecolor "#e6e6e6" linewidth 1
jnd(f) = 0.065 + 0.0633 * abs(f)
set multiplot
set lmargin 9
set rmargin 14

set origin 0, 0.38
set size 1, 0.62
set bmargin 1
set tmargin 2.5
set format x ""
set ylabel "Force [N]" textcolor "#444444"
set title "A recording of virtual silicone that the models never saw: force, and error against what a hand can notice" textcolor "#222222"
set yrange [0:7]
set label 1 "measured" at graph 1.01, 0.92 textcolor "#009E73"
set label 2 "greedy-100" at graph 1.01, 0.82 textcolor "#D55E00"
set label 3 "JND band" at graph 1.01, 0.72 textcolor "#888888"
plot forces using (column("time_s")):(column("force_N") - jnd(column("force_N"))):(column("force_N") + jnd(column("force_N"))) with filledcurves fillcolor "#dddddd" fillstyle solid noborder, \
     forces using (column("time_s")):(column("force_N")) with lines linewidth 2.5 linecolor "#009E73", \
     forces using (column("time_s")):(column("greedy-100_N")) with lines linewidth 1.5 linecolor "#D55E00"

unset title
unset label
set origin 0, 0
set size 1, 0.40
set bmargin 3.5
set tmargin 0.5
set format x "%g"
set xlabel "Time [s]" textcolor "#444444"
set ylabel "Error / JND" textcolor "#444444"
set yrange [0:2]
set ytics 0.5
set arrow 1 from graph 0, first 1 to graph 1, first 1 nohead linecolor "#888888" linewidth 2 dashtype 2
set label 4 "above 1 a hand could tell; here single samples, at first touch" at graph 0.005, first 1.75 textcolor "#888888"
set label 1 "random-100" at graph 1.01, 0.72 textcolor "#E69F00"
set label 2 "kdtree-100" at graph 1.01, 0.55 textcolor "#0072B2"
set label 3 "greedy-100" at graph 1.01, 0.38 textcolor "#D55E00"
error(model) = column("depth_m") > 0 ? abs(column(model) - column("force_N")) / jnd(column("force_N")) : 0
plot forces using (column("time_s")):(error("random-100_N")) with lines linewidth 1.2 linecolor "#E69F00", \
     forces using (column("time_s")):(error("kdtree-100_N")) with lines linewidth 1.2 linecolor "#0072B2", \
     forces using (column("time_s")):(error("greedy-100_N")) with lines linewidth 1.6 linecolor "#D55E00"
unset multiplot
