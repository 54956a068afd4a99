# Print an optspec for argparse to handle cmd's options that are independent of any subcommand.
function __fish_termtrace_global_optspecs
    string join \n eye= target= up= fov= threads= color= glyphs= cell-aspect= map= samples= quality= max-rate= fps= move-speed= turn-speed= reduced-motion= order= compressed-link quiet no-config h/help V/version
end

function __fish_termtrace_needs_command
    # Figure out if the current invocation already has a command.
    set -l cmd (commandline -opc)
    set -e cmd[1]
    argparse -s (__fish_termtrace_global_optspecs) -- $cmd 2>/dev/null
    or return
    if set -q argv[1]
        # Also print the command, so this can be used to figure out what it is.
        echo $argv[1]
        return 1
    end
    return 0
end

function __fish_termtrace_using_subcommand
    set -l cmd (__fish_termtrace_needs_command)
    test -z "$cmd"
    and return 1
    contains -- $cmd[1] $argv
end

complete -c termtrace -n "__fish_termtrace_needs_command" -l eye -d 'Where to look from, instead of the scene\'s eye point' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l target -d 'Where to look to, instead of the scene\'s target' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l up -d 'What is vertical in the picture, instead of the scene\'s up' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l fov -d 'The vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l threads -d 'How many threads trace [default: as many as there are cores]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l color -d 'Which colours the picture may have [default: auto]' -r -f -a "auto\t''
always\t''
never\t''
truecolor\t''
256\t''
16\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l glyphs -d 'What its cells are made of [default: auto]' -r -f -a "auto\t''
half\t''
shape\t''
ramp\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l cell-aspect -d 'A cell\'s height over its width [default: as the terminal says, or 2]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l map -d 'The shaded picture, or a map of the scene [default: shaded]' -r -f -a "shaded\t''
lambert\t''
depth\t''
normal\t''
object\t''
shadow\t''
cost\t''
facing\t''
contrast\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l samples -d 'Rays per pixel, also in motion, or `best`: 1, and up to 64 where there are edges [default: as many as the time allows, at rest best]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l quality -d 'How near a moving picture is to the right one; it decides bytes, not rays [default: exact; live, on a slow link, equal]' -r -f -a "exact\t''
equal\t''
fast\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l max-rate -d 'The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first [default: as many as the link takes]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l fps -d 'The most frames per second [default: 60]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l move-speed -d 'How fast keys move the eye: a factor from 0.1 to 10 [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l turn-speed -d 'How fast keys turn the view: a factor from 0.1 to 10 [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_needs_command" -l reduced-motion -d 'Each press of a key moves one step at once; nothing glides or moves by itself [default: false]' -r -f -a "true\t''
false\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l order -d 'In which order changed cells are sent [default: color; live, raster until the link is found slow]' -r -f -a "color\t''
raster\t''"
complete -c termtrace -n "__fish_termtrace_needs_command" -l compressed-link -d 'The link compresses, as ssh -C does: --order raster'
complete -c termtrace -n "__fish_termtrace_needs_command" -l quiet -d 'Do not print the camera on leaving'
complete -c termtrace -n "__fish_termtrace_needs_command" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_needs_command" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_needs_command" -s V -l version -d 'Print version'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "frame" -d 'Print one frame, or compare it with a golden one'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "record" -d 'Record a film along a camera path: asciicast, GIF or numbered PNGs'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "explain" -d 'Say what a pixel comes from: its ray, what that met, the lights'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "check" -d 'Say what is wrong with a scene file, or that it is fine'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "describe" -d 'Say in words what a picture shows'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "bench" -d 'Time the tracing of a scene'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "doctor" -d 'Say what this terminal can do and who says so, and draw a test card'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "config" -d 'Say which settings hold, and who says so'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "completions" -d 'Print what a shell is to know to complete arguments'
complete -c termtrace -n "__fish_termtrace_needs_command" -a "man" -d 'Print the manual, for man'
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l eye -d 'Where to look from, instead of the scene\'s eye point' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l target -d 'Where to look to, instead of the scene\'s target' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l up -d 'What is vertical in the picture, instead of the scene\'s up' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l fov -d 'The vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l threads -d 'How many threads trace [default: as many as there are cores]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l size -d 'The frame\'s size in cells [default: 80x24]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l pixels -d 'The frame\'s size in pixels; a cell has two of them, one above the other, or with --glyphs shape two by four' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l cell-aspect -d 'A cell\'s height over its width' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l samples -d 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 where there are edges' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l scale -d 'Picture files: make each pixel N by N of the file\'s [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l map -d 'The shaded picture, or a map of the scene [default: shaded]' -r -f -a "shaded\t''
lambert\t''
depth\t''
normal\t''
object\t''
shadow\t''
cost\t''
facing\t''
contrast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l color -d 'Which colours the picture may have [default: auto]' -r -f -a "auto\t''
always\t''
never\t''
truecolor\t''
256\t''
16\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l glyphs -d 'What its cells are made of [default: auto]' -r -f -a "auto\t''
half\t''
shape\t''
ramp\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l format -d 'What to write [default: as the file name\'s ending says, or text]' -r -f -a "text\t'Characters without colour'
ansi\t'Cells in colour'
svg\t'Cells as a drawing, one rectangle per half cell'
html\t'Cells as a web page'
png\t'A picture file, one pixel per half cell'"
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -s o -l output -d 'Write to a file; - is standard output [default: -]' -r -F
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l check -d 'Compare with the frame in a file instead of writing one; exit code 1 and a diff if they differ' -r -F
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -l bless -d 'With --check: write the file'
complete -c termtrace -n "__fish_termtrace_using_subcommand frame" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l eye -d 'Where to look from, instead of the scene\'s eye point' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l target -d 'Where to look to, instead of the scene\'s target' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l up -d 'What is vertical in the picture, instead of the scene\'s up' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l fov -d 'The vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l threads -d 'How many threads trace [default: as many as there are cores]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l path -d 'How the camera moves: orbit, or a file of keyframes' -r -F
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l seconds -d 'How long the film is [default: 8, or as long as the path file]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l fps -d 'Frames per second' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l size -d 'The frame\'s size in cells [default: 80x24]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l pixels -d 'The frame\'s size in pixels; a cell has two of them, one above the other, or with --glyphs shape two by four' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l cell-aspect -d 'A cell\'s height over its width' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l samples -d 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 where there are edges' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l scale -d 'Picture files: make each pixel N by N of the file\'s [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l map -d 'The shaded picture, or a map of the scene [default: shaded]' -r -f -a "shaded\t''
lambert\t''
depth\t''
normal\t''
object\t''
shadow\t''
cost\t''
facing\t''
contrast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l order -d 'In which order changed cells are sent [default: color; live, raster until the link is found slow]' -r -f -a "color\t''
raster\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l quality -d 'How near a moving picture is to the right one; it decides bytes, not rays [default: exact; live, on a slow link, equal]' -r -f -a "exact\t''
equal\t''
fast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l max-rate -d 'The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first [default: as many as the link takes]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -s o -l output -d 'Write to FILE.cast (asciicast), FILE.gif, or numbered from 1 to FILE-%04d.png; - is an asciicast to standard output [default: -]' -r -F
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -l compressed-link -d 'The link compresses, as ssh -C does: --order raster'
complete -c termtrace -n "__fish_termtrace_using_subcommand record" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l eye -d 'Where to look from, instead of the scene\'s eye point' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l target -d 'Where to look to, instead of the scene\'s target' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l up -d 'What is vertical in the picture, instead of the scene\'s up' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l fov -d 'The vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l threads -d 'How many threads trace [default: as many as there are cores]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l pixel -d 'The pixel\'s column and row, from (0, 0) at the top left' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l size -d 'The frame\'s size in cells [default: 80x24]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l pixels -d 'The frame\'s size in pixels; a cell has two of them, one above the other, or with --glyphs shape two by four' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l cell-aspect -d 'A cell\'s height over its width' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand explain" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l eye -d 'Where to look from, instead of the scene\'s eye point' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l target -d 'Where to look to, instead of the scene\'s target' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l up -d 'What is vertical in the picture, instead of the scene\'s up' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l fov -d 'The vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l threads -d 'How many threads trace [default: as many as there are cores]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand check" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l eye -d 'Where to look from, instead of the scene\'s eye point' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l target -d 'Where to look to, instead of the scene\'s target' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l up -d 'What is vertical in the picture, instead of the scene\'s up' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l fov -d 'The vertical field of view in degrees, instead of the scene\'s' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l threads -d 'How many threads trace [default: as many as there are cores]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l size -d 'The size of the screen whose picture is told, in cells' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand describe" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l scene -d 'A scene that is made rather than read' -r -f -a "three\t'Three spheres on a plane'
s1k\t'1,000 spheres in a cube'
s100k\t'100,000 of them, smaller'"
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l pixels -d 'The picture\'s size in pixels' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l samples -d 'Rays per pixel' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l threads -d 'How many threads trace [default: as many as there are cores]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l kernel -d 'How the rays go through the scene: it changes how long that takes, and nothing else' -r -f -a "auto\t'Together as long as that is cheaper'
single\t'One by one, against eight boxes or parts at once'
packet\t'Always together'
scalar\t'One by one, without the CPU\'s own instructions'"
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l rounds -d 'How many times' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -l no-shadow -d 'Trace no rays to the lights'
complete -c termtrace -n "__fish_termtrace_using_subcommand bench" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -l color -d 'Which colours the picture may have [default: auto]' -r -f -a "auto\t''
always\t''
never\t''
truecolor\t''
256\t''
16\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -l glyphs -d 'What its cells are made of [default: auto]' -r -f -a "auto\t''
half\t''
shape\t''
ramp\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -l cell-aspect -d 'A cell\'s height over its width [default: as the terminal says, or 2]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand doctor" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l color -d 'Which colours the picture may have [default: auto]' -r -f -a "auto\t''
always\t''
never\t''
truecolor\t''
256\t''
16\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l glyphs -d 'What its cells are made of [default: auto]' -r -f -a "auto\t''
half\t''
shape\t''
ramp\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l cell-aspect -d 'A cell\'s height over its width [default: as the terminal says, or 2]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l map -d 'The shaded picture, or a map of the scene [default: shaded]' -r -f -a "shaded\t''
lambert\t''
depth\t''
normal\t''
object\t''
shadow\t''
cost\t''
facing\t''
contrast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l samples -d 'Rays per pixel, also in motion, or `best`: 1, and up to 64 where there are edges [default: as many as the time allows, at rest best]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l quality -d 'How near a moving picture is to the right one; it decides bytes, not rays [default: exact; live, on a slow link, equal]' -r -f -a "exact\t''
equal\t''
fast\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l max-rate -d 'The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first [default: as many as the link takes]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l fps -d 'The most frames per second [default: 60]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l move-speed -d 'How fast keys move the eye: a factor from 0.1 to 10 [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l turn-speed -d 'How fast keys turn the view: a factor from 0.1 to 10 [default: 1]' -r
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l reduced-motion -d 'Each press of a key moves one step at once; nothing glides or moves by itself [default: false]' -r -f -a "true\t''
false\t''"
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -l keys -d 'Print what keys do instead, in the form of keys.ron'
complete -c termtrace -n "__fish_termtrace_using_subcommand config" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand completions" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand completions" -s h -l help -d 'Print help'
complete -c termtrace -n "__fish_termtrace_using_subcommand man" -l no-config -d 'Read none of the user\'s own files'
complete -c termtrace -n "__fish_termtrace_using_subcommand man" -s h -l help -d 'Print help'
