// What a stopping rule says after an iteration.
enum class Verdict { go_on, done, failed };
