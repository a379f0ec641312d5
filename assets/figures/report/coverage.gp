# Features of training sites and test samples against the depth. Reads coverage.csv.
reset
load "coverage.set"
load "style.gp"
stats "coverage.csv" using "depth" nooutput
set xtics tic_step(STATS_max, 4)
near_side = panel_count == 3 ? "left" : "right"
away_side = panel_count == 1 ? "center" : "left"
do for [medium in media] {
  eval open(medium, "coverage")
  set multiplot layout 1,panel_count
  set xlabel x_label
  set tmargin 1.8
  do for [p = 0:panel_count - 1] {
    unset label
    set ylabel (p == 0 ? y_label_0 : p == 1 ? y_label_1 : y_label_2) offset 1,0
    if (p == 0) { set label 1 "trained on" at graph 0,1.06 left textcolor rgb blue }
    if (p == (panel_count == 3 ? 1 : 0)) { set label 2 "test, near" at graph (panel_count == 3 ? 0 : 1),1.06 @near_side textcolor rgb muted }
    if (p == panel_count - 1) { set label 3 "test, away" at graph (panel_count == 1 ? 0.5 : 0),1.06 @away_side textcolor rgb vermilion }
    of(kind) = strcol("kind") eq kind ? column("depth") : NaN
    plot "coverage.csv" using (of("near")):(column(3 + p)) with points pointtype 7 pointsize 0.3 linecolor rgb muted, \
      "" using (of("trained")):(column(3 + p)) with points pointtype 7 pointsize 0.2 linecolor rgb blue, \
      "" using (of("away")):(column(3 + p)) with points pointtype 7 pointsize 0.35 linecolor rgb vermilion
  }
  unset multiplot
  unset output
}
