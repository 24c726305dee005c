# What the cells of one map come to: a sentence or two, or with -v row=yes -v title=T a table row.
BEGIN { FS = "," }
NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
{
  ++cells
  ++outcome[$at["outcome"]]
  if ($at["bounded"] == "yes") ++bounded
  if ($at["outcome"] == "done" && $at["iterations_median"] + 0 > median) median = $at["iterations_median"] + 0
  if ($at["outcome"] == "done" && $at["iterations_max"] + 0 > most) most = $at["iterations_max"] + 0
  if ($at["h_omega"] + 0 > h_omega) h_omega = $at["h_omega"] + 0
  if ($at["bounded"] == "") ++ended
  if ($at["linear_bounded"] != "" && $at["bounded"] != "") ++linear
  if ($at["linear_bounded"] != "" && $at["linear_bounded"] == $at["bounded"]) ++agree
  if ($at["state_error"] != "") ++known
}
END {
  if (row) {
    failed = outcome["not converged"] + outcome["left the domain"] + outcome["overflow"] + outcome["undefined"]
    printf "| %s | %d | %d | %d | %d | %d | %d | %d | %d |\n", title, cells, outcome["done"],
      outcome["jumped"], outcome["escaped"], failed + outcome["out of time"], bounded, median, most
    exit
  }
  n = split("done;jumped;escaped;not converged;left the domain;overflow;out of time;undefined", names, ";")
  for (i = 1; i <= n; ++i)
    if (outcome[names[i]]) text = text (text == "" ? "" : ", ") outcome[names[i]] " " names[i]
  printf "%d cells: %s. The state stayed bounded to the end in %d", cells, text, bounded
  if (ended > 0) printf ", and %d ended too early to tell", ended
  if (linear > 0) printf "; linear theory agrees in %d of the %d cells where both speak", agree, linear
  printf ".\nIterations of a step where all were done: at most %d in the median of a cell, %d in one step.", median, most
  if (h_omega > 0) printf " Largest h omega: %.3g.", h_omega
  if (known > 0) printf "\nThe state error is known in %d cells.", known
  printf "\n"
}
