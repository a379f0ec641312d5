# One point a seed. Reads repeatability_points.csv and repeatability_methods.csv.
reset
load "repeatability.set"
load "style.gp"
set xrange [-0.6:methods - 0.4]
do for [medium in media] {
  eval open(medium, "repeatability")
  set multiplot layout 1,2
  unset arrow
  unset label
  set ylabel "RMS error [mN]"
  set yrange [0:rms_high]
  set ytics tic_step(rms_high, 4)
  plot "repeatability_points.csv" using "place":"rms_mN":"colour" with points pointtype 7 pointsize 0.7 linecolor rgb variable, \
    "repeatability_methods.csv" using "method":(NaN):xtic(2) with points
  set ylabel "Worst error [JND]"
  set yrange [0:worst_high]
  set ytics tic_step(worst_high, 4)
  set arrow 1 from graph 0,first 1 to graph 1,first 1 nohead linewidth 1.5 dashtype 2 linecolor rgb muted
  set label 1 "JND" at graph 0.03,first 1 left offset 0,0.55 textcolor rgb muted
  plot "repeatability_points.csv" using "place":"worst_jnd":"colour" with points pointtype 7 pointsize 0.7 linecolor rgb variable, \
    "repeatability_methods.csv" using "method":(NaN):xtic(2) with points
  unset multiplot
  unset output
}
