call 'benchmarks/paper/common.gp' ARG1 ARG2
eval 'set terminal ' . terminal(1400, 1000)
set output pictures . 'figure_2.png'
file = data . 'figure_2.dat'
set multiplot layout 2,2 margins 0.125,0.98,0.07,0.955 spacing 0.115,0.11
set format y powers
set ytics add ('0' 0)
set xlabel 't' offset 0,0.6
set key top center horizontal maxrows 2
do for [k = 0:3] {
  set title (k < 2 ? 'β = γ = √(α (1 − α))' : 'β = γ = 0') . (k % 2 == 0 ? ', q(0) = 0.8' : ', q(0) = 3.1')
  if (k % 2 == 0) { set ylabel 'H − H(0)' offset 1,0 } else { unset ylabel }
  if (k == 0) { set key on; set offsets 0, 0, graph 0.25, 0 } else { set key off; set offsets 0, 0, 0, 0 }
  plot for [i = 0:5] file index 6*k + i using 1:2 with lines lt i + 1 title name(file, i)
}
unset multiplot
