#!/bin/sh
# Stands for probe-rs 0.32 where there is no probe: the arguments that it takes, what it prints and its exit codes, by the
# sources of probe-rs-tools (main.rs, cmd/run.rs, cmd/download.rs, cmd/list.rs, util/cli.rs). What a chip would have sent is in
# the folder FAKE, and so is what was asked for.
verb=$1
shift
echo "$verb $*" >> "$FAKE/asked"
if [ "$verb" = list ]; then
    if [ -e "$FAKE/no-probe" ]; then
        echo "No debug probes were found."
    else
        printf 'The following debug probes were found:\n[0]: Debugprobe on Pico (CMSIS-DAP) -- 2e8a:000c-0:E66 (CMSIS-DAP)\n'
    fi
    exit 0
fi

picture= log= path= chip= format=elf address=
while [ $# -gt 0 ]; do
    case $1 in
        --chip) chip=$2; shift ;;
        --probe | --log-format) shift ;;
        --non-interactive | --disable-progressbars) ;;
        --no-catch-hardfault | --no-timestamps) [ "$verb" = run ] || exit 2 ;;
        --target-output-file)
            [ "$verb" = run ] || exit 2
            case $2 in
                picture=*) picture=${2#picture=} ;;
                defmt=*) log=${2#defmt=} ;;
            esac
            shift ;;
        --binary-format) format=$2; shift ;;
        --base-address) address=$2; shift ;;
        -*) echo "error: unexpected argument '$1' found" >&2; exit 2 ;;
        *) path=$1 ;;
    esac
    shift
done
if [ -e "$FAKE/unplugged" ]; then
    echo "Error: No connected probes were found." >&2
    exit 1
fi
if [ ! -e "$path" ]; then
    echo "Error: Failed to read firmware from $path" >&2
    exit 1
fi
case $verb in
    download)
        cp "$path" "$FAKE/downloaded"
        echo "$chip $format $address" > "$FAKE/download"
        if [ -e "$FAKE/protected" ]; then
            echo "Error: The flash of the chip is protected." >&2
            exit 1
        fi
        exit 0 ;;
    run)
        cp "$path" "$FAKE/ran"
        # Files are appended to as bytes come, by any number at a time, and standard output has the same.
        size=$(wc -c < "$FAKE/picture")
        begin=0
        while [ $begin -lt $size ]; do
            dd if="$FAKE/picture" bs=1 skip=$begin count=777 2> "$FAKE/dd" | tee -a "$picture" | sed 's/^/[picture] /'
            begin=$((begin + 777))
        done
        tee -a "$log" < "$FAKE/log"
        if [ -e "$FAKE/hangs" ]; then
            exec sleep 60
        fi
        if [ -e "$FAKE/failure" ]; then
            cat "$FAKE/failure" >&2
            exit 1
        fi
        echo "Firmware exited successfully"
        exit 0 ;;
esac
