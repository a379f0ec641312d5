# Seconds against something, a line a method. Reads FIGURE.csv and FIGURE_labels.csv.
reset
load "FIGURE.set"
load "style.gp"
set logscale y
set yrange [y_low:y_high]
set rmargin 20
set xlabel x_label
set ylabel "Seconds"
if (x_log) {
  set logscale x
} else {
  set xtics 1
}
do for [medium in media] {
  eval open(medium, "FIGURE")
  plot "FIGURE.csv" using "x":"seconds":"colour" with linespoints pointtype 7 pointsize 0.6 linewidth 1.5 linecolor rgb variable, \
    "FIGURE_labels.csv" using "x":"seconds":"label":"colour" with labels left offset 1,0 noenhanced textcolor rgb variable
  unset output
}
