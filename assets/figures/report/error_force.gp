# Errors in bins of measured force, a panel a recipe, with the samples of every bin below.
# Reads FIGURE.csv, FIGURE_labels.csv, FIGURE_counts.csv. Hollow: few samples.
reset
load "FIGURE.set"
load "style.gp"
jnd_mN(x) = 1000 * (jnd_offset_N + jnd_fraction * x)
panels = panel_count < 1 ? 1 : panel_count
left(p) = p == 0 ? 0.09 : 0.56
right(p) = panels == 1 ? 0.85 : p == 0 ? 0.40 : 0.87
do for [medium in media] {
  eval open(medium, "FIGURE")
  set multiplot
  do for [p = 0:panels - 1] {
    unset label
    unset arrow
    set lmargin at screen left(p)
    set rmargin at screen right(p)
    set tmargin at screen 0.92
    set bmargin at screen 0.36
    set logscale y
    set xrange [0:force_high]
    set yrange [y_low:y_high]
    load "FIGURE.set"
    set format x ""
    unset xlabel
    set ylabel p == 0 ? y_label : ""
    set label 1 (p == 0 ? title_0 : title_1) at graph 0,1.05 left noenhanced textcolor rgb ink
    only(x) = column("panel") == p ? x : NaN
    if (over_jnd) {
      plot [x = 0:force_high] '+' using 1:(y_low):(1) with filledcurves fillcolor rgb band fillstyle solid noborder, \
        '+' using 1:(1000 * noise_N / jnd_mN($1)) with lines dashtype 3 linewidth 2 linecolor rgb muted, \
        "FIGURE.csv" using (only(column("force_N"))):"error":"colour" with lines linewidth 1.5 linecolor rgb variable, \
        "" using (only(column("force_N"))):"error":"colour" with points pointtype 7 pointsize 0.5 linecolor rgb variable, \
        "" using (column("few") == 1 ? only(column("force_N")) : NaN):"error" with points pointtype 7 pointsize 0.25 linecolor rgb paper, \
        "FIGURE_labels.csv" using (only(column("force_N"))):"error":"label":"colour" with labels left offset 0.5,0 noenhanced textcolor rgb variable
    } else {
      plot [x = 0:force_high] '+' using 1:(y_low):(jnd_mN($1)) with filledcurves fillcolor rgb band fillstyle solid noborder, \
        '+' using 1:(1000 * noise_N) with lines dashtype 3 linewidth 2 linecolor rgb muted, \
        "FIGURE.csv" using (only(column("force_N"))):"error":"colour" with lines linewidth 1.5 linecolor rgb variable, \
        "" using (only(column("force_N"))):"error":"colour" with points pointtype 7 pointsize 0.5 linecolor rgb variable, \
        "" using (column("few") == 1 ? only(column("force_N")) : NaN):"error" with points pointtype 7 pointsize 0.25 linecolor rgb paper, \
        "FIGURE_labels.csv" using (only(column("force_N"))):"error":"label":"colour" with labels left offset 0.5,0 noenhanced textcolor rgb variable
    }
    unset label
    set tmargin at screen 0.30
    set bmargin at screen 74.0 / height
    set format x "%g"
    set xlabel "Measured force [N]"
    set ylabel p == 0 ? "samples" : ""
    set yrange [1:*]
    set ytics (1, 100, "10^4" 1e4, "10^6" 1e6)
    set arrow 1 from graph 0,first few to graph 1,first few nohead dashtype 2 linecolor rgb muted
    plot "FIGURE_counts.csv" using "force_N":"count":"force_from_N":"force_to_N":(1):"count" with boxxyerror fillcolor rgb muted fillstyle solid 0.5 noborder
  }
  unset multiplot
  unset output
}
