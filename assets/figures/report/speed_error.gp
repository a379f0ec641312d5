# Time against the 99th percentile of error/JND, a panel a test recording; also for fit
# times. Reads FIGURE.csv (models), FIGURE_front.csv, FIGURE_labels.csv, FIGURE_panels.csv.
reset
load "FIGURE.set"
load "style.gp"
wide = 'set xtics ("10 ns" 10, "20 ns" 20, "50 ns" 50, "100 ns" 100, "200 ns" 200, "500 ns" 500, "1 µs" 1e3, "2 µs" 2e3, "5 µs" 5e3, "10 µs" 1e4, "20 µs" 2e4, "50 µs" 5e4, "100 µs" 1e5)'
narrow = 'set xtics ("10 ns" 10, "100 ns" 100, "1 µs" 1e3, "10 µs" 1e4, "100 µs" 1e5)'
seconds = 'set xtics ("1 ms" 1e-3, "10 ms" 1e-2, "0.1 s" 0.1, "1 s" 1, "10 s" 10, "100 s" 100)'
eval (is_fit ? seconds : panel_count > 1 ? narrow : wide)
rows = panel_count == 1 ? 1 : 2
columns = panel_count == 1 ? 1 : 2
do for [medium in media] {
  eval open(medium, "FIGURE")
  set multiplot layout rows,columns
  do for [p = 0:panel_count - 1] {
    unset logscale
    set xrange [*:*]
    set yrange [*:*]
    stats "FIGURE_panels.csv" using 3 every ::p::p nooutput
    floor_jnd = STATS_max
    title_of = system(sprintf("sed -n %dp FIGURE_panels.csv | cut -d, -f2", p + 2))
    set logscale xy
    set xrange [x_low:x_high]
    set yrange [y_low:y_high]
    unset label
    unset arrow
    set label 1 title_of at graph 0.02,1.03 left noenhanced textcolor rgb ink
    set label 2 (panel_count > 1 ? "1 JND" : "1 JND: a hand can just tell") at graph 0.99,first 1 right offset 0,0.5 textcolor rgb muted
    set arrow 1 from graph 0,first 1 to graph 1,first 1 nohead dashtype 2 linewidth 1.5 linecolor rgb muted
    if (floor_jnd > y_low) {
      set arrow 2 from graph 0,first floor_jnd to graph 1,first floor_jnd nohead dashtype 3 linewidth 2 linecolor rgb muted
      set label 3 "noise of the force sensor" at graph 0.99,first floor_jnd right offset 0,0.5 textcolor rgb muted
    } else {
      set label 3 sprintf("force noise: %.2g JND, below ↓", floor_jnd) at graph 0.99,0.11 right noenhanced textcolor rgb muted
    }
    set label 4 edge at graph 0.99,0.04 right noenhanced textcolor rgb muted
    set xlabel x_label
    set ylabel "99 % of errors up to [JND]"
    set tmargin 1.6
    only(x) = column("panel") == p ? x : NaN
    plot "FIGURE_front.csv" using (only(column("time"))):"p99_error_over_jnd" with steps linewidth 7 linecolor rgb band, \
      "FIGURE.csv" using (only(column("time"))):"p99_error_over_jnd":"p99_low":"p99_high":"colour" with yerrorbars pointtype 0 linewidth 0.7 linecolor rgb variable, \
      "" using (only(column("time"))):"p99_error_over_jnd":"colour" with lines linewidth 1.6 linecolor rgb variable, \
      "" using (strcol("recipe") eq "paper" ? only(column("time")) : NaN):"p99_error_over_jnd" with points pointtype 7 pointsize 0.7 linecolor rgb paper, \
      "" using (strcol("recipe") eq "paper" ? only(column("time")) : NaN):"p99_error_over_jnd":"colour" with points pointtype 6 pointsize 0.7 linewidth 1.5 linecolor rgb variable, \
      "" using (strcol("recipe") ne "paper" ? only(column("time")) : NaN):"p99_error_over_jnd":"colour" with points pointtype 7 pointsize 0.75 linecolor rgb variable, \
      "FIGURE_labels.csv" using (only(column("time"))):"p99_error_over_jnd":"label":"colour" with labels left offset 0.8,0 noenhanced textcolor rgb variable
  }
  unset multiplot
  unset output
}
