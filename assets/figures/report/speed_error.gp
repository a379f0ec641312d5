# Time against the 99th percentile of error/JND, a panel a test recording; also for fit
# times. Reads FIGURE.csv (models), FIGURE_front.csv, FIGURE_labels.csv, FIGURE_panels.csv.
reset
load "FIGURE.set"
load "style.gp"
columns = panel_count == 1 ? 1 : 2
rows = panel_count > 2 ? 2 : 1
if (is_fit) {
  set xtics ("1 ms" 1e-3, "10 ms" 1e-2, "0.1 s" 0.1, "1 s" 1, "10 s" 10, "100 s" 100)
} else {
  if (columns > 1) {
    set xtics ("10 ns" 10, "" 20 1, "" 50 1, "100 ns" 100, "" 200 1, "" 500 1, "1 µs" 1e3, "" 2e3 1, "" 5e3 1, "10 µs" 1e4, "" 2e4 1, "" 5e4 1, "100 µs" 1e5)
  } else {
    set xtics ("10 ns" 10, "20 ns" 20, "50 ns" 50, "100 ns" 100, "200 ns" 200, "500 ns" 500, "1 µs" 1e3, "2 µs" 2e3, "5 µs" 5e3, "10 µs" 1e4, "20 µs" 2e4, "50 µs" 5e4, "100 µs" 1e5)
  }
}
do for [medium in media] {
  eval open(medium, "FIGURE")
  set multiplot
  do for [p = 0:panel_count - 1] {
    unset logscale
    set xrange [*:*]
    set yrange [*:*]
    stats "FIGURE_panels.csv" using 3 every ::p::p nooutput
    floor_jnd = STATS_max
    title_of = system(sprintf("sed -n %dp FIGURE_panels.csv | cut -d, -f2", p + 2))
    column_of = p % columns
    row_of = p / columns
    set lmargin at screen (column_of + 0.0) / columns + 1.0 * margin_left / width
    set rmargin at screen (column_of + 1.0) / columns - 1.0 * margin_right / width
    set tmargin at screen 1 - (row_of + 0.0) / rows - 1.0 * margin_top / height
    set bmargin at screen 1 - (row_of + 1.0) / rows + 1.0 * margin_bottom / height
    set logscale xy
    set xrange [x_low:x_high]
    set yrange [y_low:y_high]
    unset label
    unset arrow
    set label 1 title_of at graph 0,1 left offset 0,0.7 noenhanced textcolor rgb ink
    set label 2 edge at graph 1,1 right offset 0,0.7 noenhanced textcolor rgb muted
    if (columns > 1) { unset label 2 }
    set arrow 1 from graph 0,first 1 to graph 1,first 1 nohead dashtype 2 linewidth 1.5 linecolor rgb muted
    if (floor_jnd > y_low) { set arrow 2 from graph 0,first floor_jnd to graph 1,first floor_jnd nohead dashtype 3 linewidth 2 linecolor rgb muted }
    set xlabel x_label
    set ylabel "99 % of errors up to [JND]" offset 0.5,0
    only(x) = column("panel") == p ? x : NaN
    plot "FIGURE_front.csv" using (only(column("time"))):"p99_error_over_jnd" with steps linewidth 7 linecolor rgb band, \
      "FIGURE.csv" using (only(column("time"))):"p99_error_over_jnd":"p99_low":"p99_high":"colour" with yerrorbars pointtype 0 linewidth 0.7 linecolor rgb variable, \
      "" using (only(column("time"))):"p99_error_over_jnd":"colour" with lines linewidth 1.6 linecolor rgb variable, \
      "" using (strcol("recipe") eq "paper" ? only(column("time")) : NaN):"p99_error_over_jnd" with points pointtype 7 pointsize 0.7 linecolor rgb paper, \
      "" using (strcol("recipe") eq "paper" ? only(column("time")) : NaN):"p99_error_over_jnd":"colour" with points pointtype 6 pointsize 0.7 linewidth 1.5 linecolor rgb variable, \
      "" using (strcol("recipe") ne "paper" ? only(column("time")) : NaN):"p99_error_over_jnd":"colour" with points pointtype 7 pointsize 0.75 linecolor rgb variable, \
      "FIGURE_labels.csv" using (only(column("of_time"))):"of_p99":(column("time") - column("of_time")):(column("p99_error_over_jnd") - column("of_p99")):"colour" with vectors nohead linewidth 0.6 linecolor rgb variable, \
      "" using (only(column("time"))):"p99_error_over_jnd":"label":"colour" with labels left noenhanced textcolor rgb variable
  }
  unset multiplot
  unset output
}
