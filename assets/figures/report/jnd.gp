# The JND line, and the two points that the paper's text gives. Reads jnd.csv.
reset
load "jnd.set"
load "style.gp"
set xrange [0.1:5]
set xtics 1
set xlabel "Force [N]"
jnd(x) = jnd_offset_N + jnd_fraction * x
do for [medium in media] {
  eval open(medium, "jnd")
  set multiplot layout 1,2
  set ylabel "JND [mN]"
  set yrange [0:500]
  set label 1 "12 people, pen" at 2.35,375 center textcolor rgb ink
  set label 2 "earlier, pinch" at 2.75,190 left textcolor rgb ink
  plot 1000 * jnd(x) with lines linewidth 2 dashtype 2 linecolor rgb ink, \
    "jnd.csv" using (column("own") == 1 ? column("force_N") : NaN):(1000 * column("jnd_N")) with points pointtype 7 pointsize 0.9 linecolor rgb ink, \
    "" using (column("own") == 0 ? column("force_N") : NaN):(1000 * column("jnd_N")) with points pointtype 6 pointsize 0.9 linewidth 1.5 linecolor rgb ink
  set ylabel "JND [%]"
  set yrange [0:50]
  set label 1 at 2.5,17
  set label 2 at 2.5,4.5
  plot 100 * jnd(x) / x with lines linewidth 2 dashtype 2 linecolor rgb ink, \
    "jnd.csv" using (column("own") == 1 ? column("force_N") : NaN):(100 * column("jnd_N") / column("force_N")) with points pointtype 7 pointsize 0.9 linecolor rgb ink, \
    "" using (column("own") == 0 ? column("force_N") : NaN):(100 * column("jnd_N") / column("force_N")) with points pointtype 6 pointsize 0.9 linewidth 1.5 linecolor rgb ink
  unset multiplot
  unset output
}
