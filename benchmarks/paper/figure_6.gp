call 'benchmarks/paper/common.gp' ARG1 ARG2
eval 'set terminal ' . terminal(1500, 620)
set output pictures . 'figure_6.png'
file = data . 'figure_6.dat'
set multiplot
set bmargin at screen 0.28
set tmargin at screen 0.9
set lmargin at screen 0.085
set rmargin at screen 0.315
set title 'energy error over one period'
set xlabel 't'
set ylabel 'H − H(0)' offset 1,0
set format y powers
set ytics 5e-13
set ytics add ('0' 0)
set xrange [0:122]
set yrange [-1.2e-12:1.9e-12]
# Below its panel: wherever it stood inside, curves would run through it.
set key at screen 0.02,0.15 left top Left reverse maxrows 3
plot for [i = 0:blocks(file) - 1] file index i with lines lt i + 1 title name(file, i)
set key off
set ytics autofreq
unset grid
set border 15
set palette defined (0 '#00204d', 0.35 '#31688e', 0.7 '#5ec962', 1 '#fde725')
set xlabel 'β'
set ylabel 'γ' offset 1,0
set lmargin at screen 0.40
set rmargin at screen 0.60
set title 'log10 of the spread'
set format x '%.0t·10^{%T}'
set format y '%.3f'
set xtics 2e-4
set xtics add ('0' 0)
set cbtics 1
set autoscale x
set autoscale y
set autoscale xfix
set autoscale yfix
plot data . 'figure_6_wide.dat' using 1:2:(log10($5)) with image
set lmargin at screen 0.745
set rmargin at screen 0.93
set title 'close to the best pair'
set xlabel 'β − best'
set ylabel 'γ − best' offset -0.5,0
set format y '%.0t·10^{%T}'
set ytics add ('0' 0)
set xtics 4e-10
set xtics add ('0' 0)
set format cb '%.1f'
set cbtics 0.2
plot data . 'figure_6_narrow.dat' using 3:4:(log10($5)) with image
unset multiplot
