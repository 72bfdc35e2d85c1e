# Leaves out of printed JSON what a clock, the machine's load or the day has a say in, and digests of
# files that have such numbers.
skipped { if (index($0, skipped) == 1) skipped = ""; next }
/^ *"(seconds|lazy_seconds|times|warm|cold|construct|narrow_phase|standing|cheapest|break_even|best|prices|decisions|conditions|advice|clock|load|caches|date|digest)": / {
    if (/[\[{]$/) { match($0, /^ */); skipped = substr($0, 1, RLENGTH) (/\[$/ ? "]" : "}") }
    next
}
/^ *"[^"]*\.(json|svg|md|csv)": / && !/"(counts)\.csv"/ { next }
{ print }
