# Completion of glocal in fish: glocal itself says what may come next.
function __glocal_complete
    set -l words (commandline -opc)
    set -l typed (commandline -ct)
    for line in ($words[1] complete -- $words[2..-1] $typed 2>/dev/null)
        if test "$line" = :files
            set -l kept (string match -r -- '^--[a-z-]+=' $typed)
            __fish_complete_path (string replace -r -- '^--[a-z-]+=' '' $typed) | string replace -r -- '^' "$kept"
        else
            echo $line
        end
    end
end
complete -c glocal -f -a '(__glocal_complete)'
