<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE">
<context>
    <name>AboutDialog</name>
    <message>
        <source>see the package&apos;s own files</source>
        <translation>siehe Dateien des Pakets</translation>
    </message>
    <message>
        <source>About contactbench</source>
        <translation>Über contactbench</translation>
    </message>
    <message>
        <source>contactbench {}</source>
        <translation>contactbench {}</translation>
    </message>
    <message>
        <source>Locates contacts on a probe from a single force/torque sensor and states how certain each one is. Licensed under the Apache License 2.0. For bench work and research only: not a medical device.</source>
        <translation>Findet mit einem einzigen Kraft-Momenten-Sensor, wo eine Sonde berührt wird, und gibt an, wie sicher das ist. Lizenziert unter der Apache License 2.0. Nur für Labor und Forschung: kein Medizinprodukt.</translation>
    </message>
    <message>
        <source>Component licences</source>
        <translation>Lizenzen der Bestandteile</translation>
    </message>
    <message>
        <source>Components and their licences:</source>
        <translation>Bestandteile und ihre Lizenzen:</translation>
    </message>
</context>
<context>
    <name>ActionBar</name>
    <message>
        <source>What to do next</source>
        <translation>Was als Nächstes zu tun ist</translation>
    </message>
    <message>
        <source>Message</source>
        <translation>Meldung</translation>
    </message>
</context>
<context>
    <name>AlignmentPanel</name>
    <message>
        <source>Enter numbers</source>
        <translation>Zahlen eingeben</translation>
    </message>
    <message>
        <source>Match points</source>
        <translation>Punktpaare zuordnen</translation>
    </message>
    <message>
        <source>Mounting face</source>
        <translation>Montagefläche</translation>
    </message>
    <message>
        <source>Touch marked points</source>
        <translation>Markierte Punkte berühren</translation>
    </message>
    <message>
        <source>Estimate from shape</source>
        <translation>Aus der Form schätzen</translation>
    </message>
    <message>
        <source>Load from file</source>
        <translation>Aus Datei laden</translation>
    </message>
    <message>
        <source>Alignment method</source>
        <translation>Ausrichtungsmethode</translation>
    </message>
    <message>
        <source>Position and rotation of the mesh in the sensor frame:</source>
        <translation>Lage und Drehung des Netzes im Sensorsystem:</translation>
    </message>
    <message>
        <source>Rotation about the sensor&apos;s fixed {} axis, degrees; applied in the order x, y, z</source>
        <translation>Drehung um die feste {}-Achse des Sensors, Grad; in der Reihenfolge x, y, z</translation>
    </message>
    <message>
        <source>Mesh origin along sensor {}, mm</source>
        <translation>Ursprung des Netzes entlang {} des Sensors, mm</translation>
    </message>
    <message>
        <source>about {}</source>
        <translation>um {}</translation>
    </message>
    <message>
        <source>Apply placement</source>
        <translation>Lage anwenden</translation>
    </message>
    <message>
        <source>Click a point on the mesh, then enter its position in the sensor frame. Use three widely spaced points; a fourth reveals errors.</source>
        <translation>Klicken Sie einen Punkt auf dem Netz an und geben Sie seine Lage im Sensorsystem ein. Nehmen Sie drei weit auseinanderliegende Punkte; ein vierter deckt Fehler auf.</translation>
    </message>
    <message>
        <source>Align to these points</source>
        <translation>An diesen Punkten ausrichten</translation>
    </message>
    <message>
        <source>Angle of the second point about +z, from the sensor&apos;s +x, degrees</source>
        <translation>Winkel des zweiten Punkts um +z, von +x des Sensors aus, Grad</translation>
    </message>
    <message>
        <source>Second point at</source>
        <translation>Zweiter Punkt bei</translation>
    </message>
    <message>
        <source>Height of the mounting plane above the sensor origin, mm</source>
        <translation>Höhe der Montagefläche über dem Sensorursprung, mm</translation>
    </message>
    <message>
        <source>Face height</source>
        <translation>Höhe der Fläche</translation>
    </message>
    <message>
        <source>Align this face</source>
        <translation>Diese Fläche ausrichten</translation>
    </message>
    <message>
        <source>Pick again</source>
        <translation>Neu wählen</translation>
    </message>
    <message>
        <source>Touch marked points on the probe, then choose the table: px, py, pz in the mesh frame in mm, and fx to mz in the sensor frame. The search starts from the placement above.</source>
        <translation>Berühren Sie markierte Punkte der Sonde und wählen Sie dann die Tabelle: px, py, pz im Netzsystem in mm und fx bis mz im Sensorsystem. Die Suche beginnt bei der oben angegebenen Lage.</translation>
    </message>
    <message>
        <source>Choose touches…</source>
        <translation>Berührungen wählen…</translation>
    </message>
    <message>
        <source>Touches</source>
        <translation>Berührungen</translation>
    </message>
    <message>
        <source>Tables (*.csv)</source>
        <translation>Tabellen (*.csv)</translation>
    </message>
    <message>
        <source>Puts the longest axis along z and the middle one along x. This is only a first guess: check it, then correct it by numbers or touches.</source>
        <translation>Legt die längste Achse entlang z und die mittlere entlang x. Das ist nur eine erste Schätzung: Prüfen Sie sie und berichtigen Sie sie durch Zahlen oder Berührungen.</translation>
    </message>
    <message>
        <source>Height of the probe&apos;s lowest point above the sensor origin, mm</source>
        <translation>Höhe des tiefsten Punkts der Sonde über dem Sensorursprung, mm</translation>
    </message>
    <message>
        <source>Lowest point at</source>
        <translation>Tiefster Punkt bei</translation>
    </message>
    <message>
        <source>Align by shape</source>
        <translation>Nach der Form ausrichten</translation>
    </message>
    <message>
        <source>An alignment saved by contactbench.</source>
        <translation>Eine von contactbench gespeicherte Ausrichtung.</translation>
    </message>
    <message>
        <source>Choose alignment…</source>
        <translation>Ausrichtung wählen…</translation>
    </message>
    <message>
        <source>Alignment</source>
        <translation>Ausrichtung</translation>
    </message>
    <message>
        <source>Alignments (*.json)</source>
        <translation>Ausrichtungen (*.json)</translation>
    </message>
    <message>
        <source>Click the flat face of the mesh that sits on the sensor.</source>
        <translation>Klicken Sie die ebene Fläche des Netzes an, die auf dem Sensor sitzt.</translation>
    </message>
    <message>
        <source>Face selected. If you can, click a second point that shows the rotation about z.</source>
        <translation>Fläche gewählt. Klicken Sie, wenn möglich, einen zweiten Punkt an, der die Drehung um z zeigt.</translation>
    </message>
    <message>
        <source>Face and second point selected.</source>
        <translation>Fläche und zweiter Punkt gewählt.</translation>
    </message>
</context>
<context>
    <name>CaptureState</name>
    <message>
        <source>not started</source>
        <translation>nicht begonnen</translation>
    </message>
    <message>
        <source>captured</source>
        <translation>aufgenommen</translation>
    </message>
    <message>
        <source>Turn the tool to the next pose.</source>
        <translation>Drehen Sie das Werkzeug in die nächste Pose.</translation>
    </message>
    <message>
        <source>still: press SPACE</source>
        <translation>ruhig: LEERTASTE drücken</translation>
    </message>
    <message>
        <source>Press SPACE to capture this pose.</source>
        <translation>Drücken Sie die LEERTASTE, um diese Pose aufzunehmen.</translation>
    </message>
    <message>
        <source>moving</source>
        <translation>bewegt sich</translation>
    </message>
    <message>
        <source>Hold the tool still.</source>
        <translation>Halten Sie das Werkzeug still.</translation>
    </message>
    <message>
        <source>settling</source>
        <translation>beruhigt sich</translation>
    </message>
    <message>
        <source>Keep still.</source>
        <translation>Weiter still halten.</translation>
    </message>
    <message>
        <source>still</source>
        <translation>ruhig</translation>
    </message>
    <message>
        <source>Keep still: averaging.</source>
        <translation>Still halten: Es wird gemittelt.</translation>
    </message>
    <message>
        <source>bumped</source>
        <translation>angestoßen</translation>
    </message>
    <message>
        <source>Keep still: capture restarts automatically.</source>
        <translation>Still halten: Die Aufnahme beginnt automatisch neu.</translation>
    </message>
    <message>
        <source>touched</source>
        <translation>berührt</translation>
    </message>
    <message>
        <source>Remove whatever is touching the tool.</source>
        <translation>Entfernen Sie alles, was das Werkzeug berührt.</translation>
    </message>
    <message>
        <source>no samples</source>
        <translation>keine Messwerte</translation>
    </message>
    <message>
        <source>The devices are not sending data.</source>
        <translation>Die Geräte senden keine Daten.</translation>
    </message>
    <message>
        <source>settling {seconds:.1f} s</source>
        <translation>beruhigt sich {seconds:.1f} s</translation>
    </message>
</context>
<context>
    <name>CheatSheet</name>
    <message>
        <source>Shortcuts</source>
        <translation>Tastenkürzel</translation>
    </message>
    <message>
        <source>Key</source>
        <translation>Taste</translation>
    </message>
    <message>
        <source>Action</source>
        <translation>Aktion</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>Entf</translation>
    </message>
    <message>
        <source>Leave out the selected poses; remove the selected markers</source>
        <translation>Gewählte Posen auslassen; gewählte Marker entfernen</translation>
    </message>
    <message>
        <source>Return</source>
        <translation>Return</translation>
    </message>
    <message>
        <source>Restore the selected poses</source>
        <translation>Gewählte Posen wieder einbeziehen</translation>
    </message>
    <message>
        <source>Arrow keys</source>
        <translation>Pfeiltasten</translation>
    </message>
    <message>
        <source>Choose a point in the facets chart; move a range handle</source>
        <translation>Punkt im Facettendiagramm wählen; Griff eines Bereichs verschieben</translation>
    </message>
    <message>
        <source>Drag with the left or right button</source>
        <translation>Mit linker oder rechter Taste ziehen</translation>
    </message>
    <message>
        <source>Rotate the view</source>
        <translation>Ansicht drehen</translation>
    </message>
    <message>
        <source>Drag with the middle button</source>
        <translation>Mit mittlerer Taste ziehen</translation>
    </message>
    <message>
        <source>Pan the view</source>
        <translation>Ansicht verschieben</translation>
    </message>
    <message>
        <source>Wheel</source>
        <translation>Mausrad</translation>
    </message>
    <message>
        <source>Zoom in or out</source>
        <translation>Hinein- oder herauszoomen</translation>
    </message>
    <message>
        <source>Ctrl + wheel</source>
        <translation>Strg + Mausrad</translation>
    </message>
    <message>
        <source>Larger or smaller brush</source>
        <translation>Größerer oder kleinerer Pinsel</translation>
    </message>
    <message>
        <source>Hold Shift</source>
        <translation>Umschalt halten</translation>
    </message>
    <message>
        <source>Swap brush and eraser</source>
        <translation>Pinsel und Radierer vertauschen</translation>
    </message>
    <message>
        <source>Esc</source>
        <translation>Esc</translation>
    </message>
    <message>
        <source>Have the probe go back (motion control)</source>
        <translation>Sonde zurückziehen (Bewegungsregelung)</translation>
    </message>
    <message>
        <source>P</source>
        <translation>P</translation>
    </message>
    <message>
        <source>Play or pause (heatmap viewer)</source>
        <translation>Abspielen oder anhalten (Heatmap-Betrachter)</translation>
    </message>
    <message>
        <source>Ctrl+S</source>
        <translation>Strg+S</translation>
    </message>
    <message>
        <source>Save a picture (heatmap viewer)</source>
        <translation>Bild speichern (Heatmap-Betrachter)</translation>
    </message>
</context>
<context>
    <name>Checklist</name>
    <message>
        <source>Open step</source>
        <translation>Schritt öffnen</translation>
    </message>
    <message>
        <source>Open {name}</source>
        <translation>{name} öffnen</translation>
    </message>
    <message>
        <source>Sensor</source>
        <translation>Sensor</translation>
    </message>
    <message>
        <source>Calibration</source>
        <translation>Kalibrierung</translation>
    </message>
    <message>
        <source>Probe</source>
        <translation>Sonde</translation>
    </message>
    <message>
        <source>Regions</source>
        <translation>Regionen</translation>
    </message>
    <message>
        <source>Verification</source>
        <translation>Überprüfung</translation>
    </message>
    <message>
        <source>Known weight</source>
        <translation>Bekanntes Gewicht</translation>
    </message>
    <message>
        <source>Known touch</source>
        <translation>Bekannter Druckpunkt</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>Bericht</translation>
    </message>
    <message>
        <source>done</source>
        <translation>erledigt</translation>
    </message>
    <message>
        <source>stale</source>
        <translation>veraltet</translation>
    </message>
    <message>
        <source>missing</source>
        <translation>fehlt</translation>
    </message>
    <message>
        <source>not passed</source>
        <translation>nicht bestanden</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>ausgelassen</translation>
    </message>
</context>
<context>
    <name>ColourBar</name>
    <message>
        <source>darkest: up to {largest:.3g}</source>
        <translation>am dunkelsten: bis {largest:.3g}</translation>
    </message>
    <message>
        <source>{title}: from {low:.3g} to {high:.3g}</source>
        <translation>{title}: von {low:.3g} bis {high:.3g}</translation>
    </message>
</context>
<context>
    <name>ColourMenu</name>
    <message>
        <source>{0} (in use)</source>
        <translation>{0} (in Gebrauch)</translation>
    </message>
    <message>
        <source>Other colour…</source>
        <translation>Andere Farbe…</translation>
    </message>
    <message>
        <source>Orange</source>
        <translation>Orange</translation>
    </message>
    <message>
        <source>Sky blue</source>
        <translation>Himmelblau</translation>
    </message>
    <message>
        <source>Green</source>
        <translation>Grün</translation>
    </message>
    <message>
        <source>Yellow</source>
        <translation>Gelb</translation>
    </message>
    <message>
        <source>Blue</source>
        <translation>Blau</translation>
    </message>
    <message>
        <source>Red-orange</source>
        <translation>Rotorange</translation>
    </message>
    <message>
        <source>Pink</source>
        <translation>Rosa</translation>
    </message>
    <message>
        <source>Region colour</source>
        <translation>Farbe der Region</translation>
    </message>
</context>
<context>
    <name>Coverage</name>
    <message>
        <source>Coverage of gravity directions</source>
        <translation>Abdeckung der Schwerkraftrichtungen</translation>
    </message>
    <message>
        <source>Poses: {taken} captured, {left} left out, {rejected} rejected</source>
        <translation>Posen: {taken} aufgenommen, {left} ausgelassen, {rejected} abgelehnt</translation>
    </message>
    <message>
        <source>gravity towards the tool (+z)</source>
        <translation>zum Werkzeug hin (+z)</translation>
    </message>
    <message>
        <source>away from the tool (-z)</source>
        <translation>vom Werkzeug weg (-z)</translation>
    </message>
    <message>
        <source>Gravity directions in the sensor frame. Filled: captured; hollow: left out; cross: rejected; ring: next pose; dark dot: now. Well-spread poses give the best calibration.</source>
        <translation>Schwerkraftrichtungen im Sensorsystem. Gefüllt: aufgenommen; hohl: ausgelassen; Kreuz: abgelehnt; Ring: nächste Pose; dunkler Punkt: jetzt. Weit verteilte Posen ergeben die beste Kalibrierung.</translation>
    </message>
</context>
<context>
    <name>Departure</name>
    <message>
        <source>Work in progress</source>
        <translation>Laufende Arbeit</translation>
    </message>
    <message>
        <source>Stopping keeps all settings and recordings. The computation starts again when you reopen the session.</source>
        <translation>Beim Stoppen bleiben alle Einstellungen und Aufzeichnungen erhalten. Beim nächsten Öffnen der Sitzung wird neu gerechnet.</translation>
    </message>
    <message>
        <source>Stopping keeps everything recorded so far. You can continue from there next time.</source>
        <translation>Beim Stoppen bleibt alles bisher Aufgezeichnete erhalten. Sie können beim nächsten Mal dort weitermachen.</translation>
    </message>
    <message>
        <source>Wait until done</source>
        <translation>Warten, bis es fertig ist</translation>
    </message>
    <message>
        <source>Stop and keep results</source>
        <translation>Stoppen, Ergebnisse behalten</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>The session closes as soon as the work is done. You can keep working until then.</source>
        <translation>Die Sitzung schließt, sobald die Arbeit fertig ist. Bis dahin können Sie weiterarbeiten.</translation>
    </message>
</context>
<context>
    <name>DeviceChannels</name>
    <message>
        <source>Noise and headroom per channel</source>
        <translation>Rauschen und Reserve je Kanal</translation>
    </message>
    <message>
        <source>channel</source>
        <translation>Kanal</translation>
    </message>
    <message>
        <source>noise</source>
        <translation>Rauschen</translation>
    </message>
    <message>
        <source>Standard deviation of one reading at rest, N or N·m</source>
        <translation>Standardabweichung eines Messwerts in Ruhe, N oder N·m</translation>
    </message>
    <message>
        <source>largest</source>
        <translation>größter</translation>
    </message>
    <message>
        <source>Largest absolute reading in the last 5 s, N or N·m</source>
        <translation>Größter Betrag eines Messwerts in den letzten 5 s, N oder N·m</translation>
    </message>
    <message>
        <source>of range</source>
        <translation>v. Bereich</translation>
    </message>
    <message>
        <source>Share of the sensor&apos;s range; readings above 100 % are clipped</source>
        <translation>Anteil am Messbereich des Sensors; Werte über 100 % werden abgeschnitten</translation>
    </message>
    <message>
        <source>unknown</source>
        <translation>unbekannt</translation>
    </message>
</context>
<context>
    <name>DeviceTrial</name>
    <message>
        <source>Connection</source>
        <translation>Verbindung</translation>
    </message>
    <message>
        <source>Measured readings per second</source>
        <translation>Gemessene Messwerte pro Sekunde</translation>
    </message>
    <message>
        <source>– Hz</source>
        <translation>– Hz</translation>
    </message>
    <message>
        <source>{rate:.0f} Hz</source>
        <translation>{rate:.0f} Hz</translation>
    </message>
    <message>
        <source>Not connected</source>
        <translation>Nicht verbunden</translation>
    </message>
    <message>
        <source>Connected</source>
        <translation>Verbunden</translation>
    </message>
    <message>
        <source>Waiting</source>
        <translation>Wartet</translation>
    </message>
    <message>
        <source>Silent</source>
        <translation>Stumm</translation>
    </message>
    <message>
        <source>Lost</source>
        <translation>Verloren</translation>
    </message>
    <message>
        <source>Ended</source>
        <translation>Beendet</translation>
    </message>
    <message>
        <source>no gaps</source>
        <translation>keine Lücken</translation>
    </message>
    <message>
        <source>{count} gaps in 5 s, longest {longest:.0f} ms</source>
        <translation>{count} Lücken in 5 s, längste {longest:.0f} ms</translation>
    </message>
    <message>
        <source>no poses</source>
        <translation>keine Posen</translation>
    </message>
    <message>
        <source>poses {rate:.0f} Hz</source>
        <translation>Posen {rate:.0f} Hz</translation>
    </message>
    <message>
        <source>{samples:,} readings, {lost:,} lost, {gaps}; {poses}</source>
        <translation>{samples:,} Messwerte, {lost:,} verloren, {gaps}; {poses}</translation>
    </message>
</context>
<context>
    <name>DevicesPage</name>
    <message>
        <source>see the sensor&apos;s label</source>
        <translation>siehe Typenschild</translation>
    </message>
    <message>
        <source>Sensor serial number</source>
        <translation>Seriennummer des Sensors</translation>
    </message>
    <message>
        <source>Mounting angle about {axis}</source>
        <translation>Montagewinkel um {axis}</translation>
    </message>
    <message>
        <source>Rotation of the sensor on the flange about the flange&apos;s fixed axes, in the order x, y, z</source>
        <translation>Drehung des Sensors auf dem Flansch um die festen Flanschachsen, in der Reihenfolge x, y, z</translation>
    </message>
    <message>
        <source>Test connection</source>
        <translation>Verbindung testen</translation>
    </message>
    <message>
        <source>Use these devices</source>
        <translation>Diese Geräte nutzen</translation>
    </message>
    <message>
        <source>Devices</source>
        <translation>Geräte</translation>
    </message>
    <message>
        <source>for the report</source>
        <translation>für den Bericht</translation>
    </message>
    <message>
        <source>Number of the sensor&apos;s calibration certificate</source>
        <translation>Nummer des Kalibrierscheins des Sensors</translation>
    </message>
    <message>
        <source>YYYY-MM-DD</source>
        <translation>JJJJ-MM-TT</translation>
    </message>
    <message>
        <source>Date until which the certificate is valid, YYYY-MM-DD</source>
        <translation>Datum, bis zu dem der Kalibrierschein gilt, JJJJ-MM-TT</translation>
    </message>
    <message>
        <source>Mounting</source>
        <translation>Montage</translation>
    </message>
    <message>
        <source>Identification</source>
        <translation>Kennzeichnung</translation>
    </message>
    <message>
        <source>Sensor on the flange</source>
        <translation>Sensor am Flansch</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>Seriennummer</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>Kalibrierschein</translation>
    </message>
    <message>
        <source>Valid until</source>
        <translation>Gültig bis</translation>
    </message>
    <message>
        <source>Measured</source>
        <translation>Gemessen</translation>
    </message>
    <message>
        <source>Next: Gravity</source>
        <translation>Weiter: Schwerkraft</translation>
    </message>
    <message>
        <source>These devices are recording. Stop the recording before you change them.</source>
        <translation>Mit diesen Geräten läuft eine Aufzeichnung. Beenden Sie sie, bevor Sie die Geräte wechseln.</translation>
    </message>
    <message>
        <source>Opening devices…</source>
        <translation>Geräte werden geöffnet…</translation>
    </message>
    <message>
        <source>Testing connection</source>
        <translation>Die Verbindung wird getestet</translation>
    </message>
    <message>
        <source>choose devices</source>
        <translation>Geräte wählen</translation>
    </message>
    <message>
        <source>Opening devices</source>
        <translation>Die Geräte werden geöffnet</translation>
    </message>
    <message>
        <source>Could not open the devices: {why}</source>
        <translation>Die Geräte konnten nicht geöffnet werden: {why}</translation>
    </message>
    <message>
        <source>Could not save the device settings: {why}</source>
        <translation>Die Geräteeinstellungen konnten nicht gespeichert werden: {why}</translation>
    </message>
    <message>
        <source>Closing devices</source>
        <translation>Die Geräte werden geschlossen</translation>
    </message>
</context>
<context>
    <name>Docks</name>
    <message>
        <source>Steps</source>
        <translation>Schritte</translation>
    </message>
    <message>
        <source>Step</source>
        <translation>Schritt</translation>
    </message>
    <message>
        <source>Charts</source>
        <translation>Diagramme</translation>
    </message>
    <message>
        <source>Messages</source>
        <translation>Meldungen</translation>
    </message>
</context>
<context>
    <name>ErrorView</name>
    <message>
        <source>Mean error</source>
        <translation>Mittlerer Fehler</translation>
    </message>
    <message>
        <source>{mean}{spread} mm</source>
        <translation>{mean}{spread} mm</translation>
    </message>
    <message>
        <source>last {size} mm</source>
        <translation>zuletzt {size} mm</translation>
    </message>
</context>
<context>
    <name>ExportPage</name>
    <message>
        <source>Export</source>
        <translation>Export</translation>
    </message>
    <message>
        <source>Contents</source>
        <translation>Inhalt</translation>
    </message>
    <message>
        <source>Settings</source>
        <translation>Einstellungen</translation>
    </message>
    <message>
        <source>Export without verification</source>
        <translation>Ohne Überprüfung exportieren</translation>
    </message>
    <message>
        <source>For trials only: the bundle is marked as not verified</source>
        <translation>Nur für Versuche: Das Paket wird als nicht überprüft gekennzeichnet</translation>
    </message>
    <message>
        <source>Export file…</source>
        <translation>Als Datei…</translation>
    </message>
    <message>
        <source>One zip file that a robot&apos;s runtime loads directly</source>
        <translation>Eine Zip-Datei, die der Robotercomputer direkt lädt</translation>
    </message>
    <message>
        <source>Export folder…</source>
        <translation>Als Ordner…</translation>
    </message>
    <message>
        <source>Open report</source>
        <translation>Bericht öffnen</translation>
    </message>
    <message>
        <source>Show in folder</source>
        <translation>Im Ordner zeigen</translation>
    </message>
    <message>
        <source>Robot payload</source>
        <translation>Nutzlast des Roboters</translation>
    </message>
    <message>
        <source>Live outputs</source>
        <translation>Live-Ausgaben</translation>
    </message>
    <message>
        <source>Checking the bundle</source>
        <translation>Das Paket wird geprüft</translation>
    </message>
    <message>
        <source>The sensor rate is unknown because nothing has been verified. Verify in step 5, or enter Readings under Settings to match the sensor.</source>
        <translation>Die Rate des Sensors ist unbekannt, weil noch nichts überprüft wurde. Überprüfen Sie in Schritt 5, oder geben Sie unter „Einstellungen“ bei „Messwerte“ die Rate des Sensors ein.</translation>
    </message>
    <message>
        <source>total {size}, SHA-256 {sha256}…</source>
        <translation>gesamt {size}, SHA-256 {sha256}…</translation>
    </message>
    <message>
        <source>Nothing has been exported from this session yet.</source>
        <translation>Aus dieser Sitzung wurde noch nichts exportiert.</translation>
    </message>
    <message>
        <source>Changes since the last export:</source>
        <translation>Änderungen seit dem letzten Export:</translation>
    </message>
    <message>
        <source>Not verified: {why}</source>
        <translation>Nicht überprüft: {why}</translation>
    </message>
    <message>
        <source>Verified and exported.</source>
        <translation>Überprüft und exportiert.</translation>
    </message>
    <message>
        <source>Verified and ready to export.</source>
        <translation>Überprüft und bereit zum Export.</translation>
    </message>
    <message>
        <source>Sensor</source>
        <translation>Sensor</translation>
    </message>
    <message>
        <source>Readings</source>
        <translation>Messwerte</translation>
    </message>
    <message>
        <source>Payload</source>
        <translation>Nutzlast</translation>
    </message>
    <message>
        <source>Limits</source>
        <translation>Grenzen</translation>
    </message>
    <message>
        <source>Gains</source>
        <translation>Verstärkungen</translation>
    </message>
    <message>
        <source>Contact error</source>
        <translation>Kontaktfehler</translation>
    </message>
    <message>
        <source>Made by</source>
        <translation>Erstellt von</translation>
    </message>
    <message>
        <source>Probe</source>
        <translation>Sonde</translation>
    </message>
    <message>
        <source>Export file</source>
        <translation>Als Datei exportieren</translation>
    </message>
    <message>
        <source>Bundles (*.zip)</source>
        <translation>Pakete (*.zip)</translation>
    </message>
    <message>
        <source>Export folder: enter a name</source>
        <translation>Als Ordner exportieren: Namen eingeben</translation>
    </message>
    <message>
        <source>Exporting</source>
        <translation>Export läuft</translation>
    </message>
</context>
<context>
    <name>ExportSettingsPanel</name>
    <message>
        <source>Sensor model</source>
        <translation>Modell des Sensors</translation>
    </message>
    <message>
        <source>unknown</source>
        <translation>unbekannt</translation>
    </message>
    <message>
        <source>Sensor</source>
        <translation>Sensor</translation>
    </message>
    <message>
        <source>Sensor serial number</source>
        <translation>Seriennummer des Sensors</translation>
    </message>
    <message>
        <source>from the session</source>
        <translation>aus der Sitzung</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>Seriennummer</translation>
    </message>
    <message>
        <source>Sensor name in the robot description, for ros2.yaml</source>
        <translation>Name des Sensors in der Roboterbeschreibung, für ros2.yaml</translation>
    </message>
    <message>
        <source>enter later</source>
        <translation>später eintragen</translation>
    </message>
    <message>
        <source>ROS name</source>
        <translation>ROS-Name</translation>
    </message>
    <message>
        <source>Person responsible</source>
        <translation>Verantwortliche Person</translation>
    </message>
    <message>
        <source>author of the latest result</source>
        <translation>Person hinter dem neuesten Ergebnis</translation>
    </message>
    <message>
        <source>Operator</source>
        <translation>Bedienperson</translation>
    </message>
    <message>
        <source>Filter wrench</source>
        <translation>Kraft/Moment filtern</translation>
    </message>
    <message>
        <source>Kalman filter: less noise, slight lag</source>
        <translation>Kalman-Filter: weniger Rauschen, etwas Verzögerung</translation>
    </message>
    <message>
        <source>Accept contacts on regions only</source>
        <translation>Nur Kontakte auf Regionen annehmen</translation>
    </message>
    <message>
        <source>The runtime rejects contacts outside all painted regions</source>
        <translation>Der Robotercomputer verwirft Kontakte außerhalb aller gemalten Regionen</translation>
    </message>
    <message>
        <source>Controller gains</source>
        <translation>Reglerverstärkungen</translation>
    </message>
    <message>
        <source>Controller gains for pressing and following: gains.json from contactbench bench control tune</source>
        <translation>Reglerverstärkungen für Drücken und Folgen: gains.json von contactbench bench control tune</translation>
    </message>
    <message>
        <source>Remove gains</source>
        <translation>Verstärkungen entfernen</translation>
    </message>
    <message>
        <source>Gains</source>
        <translation>Verstärkungen</translation>
    </message>
    <message>
        <source>Open gains</source>
        <translation>Verstärkungen öffnen</translation>
    </message>
    <message>
        <source>Gains (*.json)</source>
        <translation>Verstärkungen (*.json)</translation>
    </message>
    <message>
        <source>{name}; left empty: {otherwise}</source>
        <translation>{name}; leer gelassen: {otherwise}</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>weggelassen</translation>
    </message>
    <message>
        <source>{force:g} N, {variant}</source>
        <translation>{force:g} N, {variant}</translation>
    </message>
    <message>
        <source>predictive</source>
        <translation>vorausschauend</translation>
    </message>
    <message>
        <source>basic</source>
        <translation>einfach</translation>
    </message>
</context>
<context>
    <name>FacetsSection</name>
    <message>
        <source>4  Facets</source>
        <translation>4  Facetten</translation>
    </message>
    <message>
        <source>Overlay the original</source>
        <translation>Original überlagern</translation>
    </message>
    <message>
        <source>Colour by deviation</source>
        <translation>Nach Abweichung färben</translation>
    </message>
    <message>
        <source>Distance from the outer surface to the simplified surface, mm</source>
        <translation>Abstand der Außenfläche zur vereinfachten Fläche, mm</translation>
    </message>
    <message>
        <source>Number of facets, or mm</source>
        <translation>Anzahl der Facetten, oder mm</translation>
    </message>
    <message>
        <source>Limit by</source>
        <translation>Begrenzen nach</translation>
    </message>
    <message>
        <source>Limit</source>
        <translation>Grenze</translation>
    </message>
    <message>
        <source>Copy painted regions</source>
        <translation>Gemalte Regionen übernehmen</translation>
    </message>
    <message>
        <source>{:,} facets</source>
        <translation>{:,} Facetten</translation>
    </message>
</context>
<context>
    <name>Faults</name>
    <message>
        <source>The disk is full ({}). Earlier recordings are safe. Free some space, then try again.</source>
        <translation>Der Datenträger ist voll ({}). Frühere Aufzeichnungen sind sicher. Schaffen Sie Platz und versuchen Sie es noch einmal.</translation>
    </message>
    <message>
        <source>Not enough memory. Close other programs or use a smaller file, then try again.</source>
        <translation>Der Arbeitsspeicher reicht nicht. Schließen Sie andere Programme oder nehmen Sie eine kleinere Datei, und versuchen Sie es noch einmal.</translation>
    </message>
</context>
<context>
    <name>FileField</name>
    <message>
        <source>Choose…</source>
        <translation>Wählen…</translation>
    </message>
</context>
<context>
    <name>FindingCards</name>
    <message>
        <source>Findings</source>
        <translation>Befunde</translation>
    </message>
    <message>
        <source>Apply fix</source>
        <translation>Korrigieren</translation>
    </message>
</context>
<context>
    <name>GravityFigures</name>
    <message>
        <source>contact error from calibration (1 sigma)</source>
        <translation>Kontaktfehler durch die Kalibrierung (1 Sigma)</translation>
    </message>
    <message>
        <source>Contact error caused by the calibration alone, mm: worst case over the intended touches. 0.5 mm is good.</source>
        <translation>Kontaktfehler allein durch die Kalibrierung, mm: schlechtester Fall der vorgesehenen Berührungen. 0.5 mm ist gut.</translation>
    </message>
    <message>
        <source>Error after each pose, logarithmic scale; dashed: 0.5 mm, the limit for good</source>
        <translation>Fehler nach jeder Pose, logarithmische Skala; gestrichelt: 0.5 mm, die Grenze für gut</translation>
    </message>
    <message>
        <source>pose {count} of about {expected}</source>
        <translation>Pose {count} von etwa {expected}</translation>
    </message>
    <message>
        <source>{count} poses: enough</source>
        <translation>{count} Posen: genug</translation>
    </message>
    <message>
        <source>poses: {count}</source>
        <translation>Posen: {count}</translation>
    </message>
</context>
<context>
    <name>GravityPage</name>
    <message>
        <source>Capture this pose (gravity)</source>
        <translation>Diese Pose aufnehmen (Schwerkraft)</translation>
    </message>
    <message>
        <source>Action failed</source>
        <translation>Aktion fehlgeschlagen</translation>
    </message>
    <message>
        <source>Checked with a new pose</source>
        <translation>Mit einer neuen Pose geprüft</translation>
    </message>
    <message>
        <source>So far: {level}</source>
        <translation>Bisher: {level}</translation>
    </message>
    <message>
        <source>good</source>
        <translation>gut</translation>
    </message>
    <message>
        <source>usable</source>
        <translation>brauchbar</translation>
    </message>
    <message>
        <source>not good enough to use</source>
        <translation>nicht gut genug</translation>
    </message>
    <message>
        <source>A calibration needs at least three poses.</source>
        <translation>Eine Kalibrierung braucht mindestens drei Posen.</translation>
    </message>
    <message>
        <source>Open Devices</source>
        <translation>Geräte öffnen</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Stopp</translation>
    </message>
    <message>
        <source>Starting…</source>
        <translation>Wird gestartet…</translation>
    </message>
    <message>
        <source>Finish</source>
        <translation>Beenden</translation>
    </message>
    <message>
        <source>Computing…</source>
        <translation>Wird berechnet…</translation>
    </message>
    <message>
        <source>Waiting for a still pose…</source>
        <translation>Wartet auf eine ruhige Pose…</translation>
    </message>
    <message>
        <source>Start over</source>
        <translation>Neu beginnen</translation>
    </message>
    <message>
        <source>Continue {recording}</source>
        <translation>{recording} fortsetzen</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Starten</translation>
    </message>
    <message>
        <source>Add poses</source>
        <translation>Posen hinzufügen</translation>
    </message>
    <message>
        <source>Check with another pose</source>
        <translation>Mit weiterer Pose prüfen</translation>
    </message>
    <message>
        <source>Next: Probe</source>
        <translation>Weiter: Sonde</translation>
    </message>
    <message>
        <source>set the tilt limit to {degrees}°</source>
        <translation>Neigungsgrenze auf {degrees}° setzen</translation>
    </message>
    <message>
        <source>set the down direction</source>
        <translation>Abwärtsrichtung angeben</translation>
    </message>
    <message>
        <source>set the orientation accuracy</source>
        <translation>Genauigkeit der Orientierung angeben</translation>
    </message>
</context>
<context>
    <name>GravityPanel</name>
    <message>
        <source>Gravity</source>
        <translation>Schwerkraft</translation>
    </message>
    <message>
        <source>Hold the tool still in about six different tilts, touching nothing. These poses determine the tool&apos;s weight and the sensor offset, which are then subtracted from every reading.</source>
        <translation>Halten Sie das Werkzeug in etwa sechs verschiedenen Neigungen still, ohne etwas zu berühren. Aus diesen Posen werden das Gewicht des Werkzeugs und der Nullpunkt des Sensors bestimmt und dann von jedem Messwert abgezogen.</translation>
    </message>
    <message>
        <source>Capture automatically when still</source>
        <translation>Automatisch aufnehmen, wenn ruhig</translation>
    </message>
    <message>
        <source>Off: press SPACE or the foot switch to capture each pose.</source>
        <translation>Aus: Jede Pose mit der LEERTASTE oder dem Fußschalter aufnehmen.</translation>
    </message>
    <message>
        <source>Move virtual tool there</source>
        <translation>Virtuelles Werkzeug bewegen</translation>
    </message>
    <message>
        <source>Bump virtual tool</source>
        <translation>Virtuelles Werkzeug anstoßen</translation>
    </message>
    <message>
        <source>Push the virtual tool briefly to see the effect</source>
        <translation>Das virtuelle Werkzeug kurz anstoßen, um die Wirkung zu sehen</translation>
    </message>
    <message>
        <source>Leave out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>Restore</source>
        <translation>Wieder einbeziehen</translation>
    </message>
    <message>
        <source>Leave out the selected poses (Delete)</source>
        <translation>Die gewählten Posen auslassen (Entf)</translation>
    </message>
    <message>
        <source>Restore the selected poses (Return)</source>
        <translation>Die gewählten Posen wieder einbeziehen (Return)</translation>
    </message>
    <message>
        <source>Add poses</source>
        <translation>Posen hinzufügen</translation>
    </message>
    <message>
        <source>Start over</source>
        <translation>Neu beginnen</translation>
    </message>
    <message>
        <source>Tilt limit of the tool</source>
        <translation>Größte Neigung des Werkzeugs</translation>
    </message>
    <message>
        <source>Largest angle between the sensor&apos;s z axis and straight down, degrees. Poses beyond it are not proposed.</source>
        <translation>Größter Winkel zwischen der z-Achse des Sensors und senkrecht nach unten, in Grad; Posen darüber hinaus werden nicht vorgeschlagen.</translation>
    </message>
    <message>
        <source>Robot base</source>
        <translation>Roboterbasis</translation>
    </message>
    <message>
        <source>upright</source>
        <translation>aufrecht</translation>
    </message>
    <message>
        <source>on the ceiling</source>
        <translation>an der Decke</translation>
    </message>
    <message>
        <source>on a wall, +x down</source>
        <translation>an der Wand, +x nach unten</translation>
    </message>
    <message>
        <source>on a wall, -x down</source>
        <translation>an der Wand, -x nach unten</translation>
    </message>
    <message>
        <source>on a wall, +y down</source>
        <translation>an der Wand, +y nach unten</translation>
    </message>
    <message>
        <source>on a wall, -y down</source>
        <translation>an der Wand, -y nach unten</translation>
    </message>
    <message>
        <source>Direction of gravity in the frame of the orientations. For other directions: session set calibration.down</source>
        <translation>Richtung der Schwerkraft im Koordinatensystem der Orientierungen. Andere Richtungen: session set calibration.down</translation>
    </message>
    <message>
        <source>from a robot ({degrees}°)</source>
        <translation>vom Roboter ({degrees}°)</translation>
    </message>
    <message>
        <source>from a tracker ({degrees}°)</source>
        <translation>vom Tracker ({degrees}°)</translation>
    </message>
    <message>
        <source>by hand ({degrees}°)</source>
        <translation>von Hand ({degrees}°)</translation>
    </message>
    <message>
        <source>Orientation accuracy</source>
        <translation>Genauigkeit der Orientierung</translation>
    </message>
    <message>
        <source>from the poses</source>
        <translation>aus den Posen</translation>
    </message>
    <message>
        <source>1 sigma about each axis. Orientation errors shift the weight in the readings.</source>
        <translation>1 Sigma um jede Achse. Fehler der Orientierung verschieben das Gewicht in den Messwerten.</translation>
    </message>
    <message>
        <source>Tilt the tool to match the ghost: {words}</source>
        <translation>Werkzeug wie den Umriss neigen: {words}</translation>
    </message>
    <message>
        <source>In position: keep still.</source>
        <translation>In Position: still halten.</translation>
    </message>
    <message>
        <source>{angle:.0f}° to go.</source>
        <translation>noch {angle:.0f}°.</translation>
    </message>
</context>
<context>
    <name>GravityRun</name>
    <message>
        <source>Loading calibration</source>
        <translation>Die Kalibrierung wird geladen</translation>
    </message>
    <message>
        <source>Compensating readings</source>
        <translation>Messwerte werden kompensiert</translation>
    </message>
    <message>
        <source>Starting recording</source>
        <translation>Die Aufzeichnung beginnt</translation>
    </message>
    <message>
        <source>Opening devices. The first pose can be captured afterwards.</source>
        <translation>Die Geräte werden geöffnet. Danach kann die erste Pose aufgenommen werden.</translation>
    </message>
    <message>
        <source>No device is open. Choose and open a sensor under Devices first.</source>
        <translation>Kein Gerät ist geöffnet. Wählen und öffnen Sie zuerst unter Geräte einen Sensor.</translation>
    </message>
    <message>
        <source>No pose source. The sensor&apos;s orientation is needed to separate the weight from the sensor offset. Choose a robot, a pose file or the virtual bench under Devices.</source>
        <translation>Keine Quelle für Posen. Um das Gewicht vom Nullpunkt des Sensors zu trennen, muss seine Orientierung bekannt sein. Wählen Sie unter Geräte einen Roboter, eine Datei mit Posen oder den virtuellen Messplatz.</translation>
    </message>
    <message>
        <source>calibrate gravity</source>
        <translation>Schwerkraft kalibrieren</translation>
    </message>
    <message>
        <source>Gravity: {why}</source>
        <translation>Schwerkraft: {why}</translation>
    </message>
    <message>
        <source>Computing calibration</source>
        <translation>Die Kalibrierung wird berechnet</translation>
    </message>
    <message>
        <source>Saving recording</source>
        <translation>Die Aufzeichnung wird gesichert</translation>
    </message>
    <message>
        <source>All devices are sending samples again. Recording continues.</source>
        <translation>Alle Geräte senden wieder Messwerte. Die Aufzeichnung geht weiter.</translation>
    </message>
    <message>
        <source>The calibration was checked with a new pose and is good.</source>
        <translation>Die Kalibrierung wurde mit einer neuen Pose geprüft und ist gut.</translation>
    </message>
    <message>
        <source>The calibration was checked with a new pose and is usable.</source>
        <translation>Die Kalibrierung wurde mit einer neuen Pose geprüft und ist brauchbar.</translation>
    </message>
    <message>
        <source>The calibration failed the check with a new pose. Do not use it.</source>
        <translation>Die Kalibrierung hat die Prüfung mit einer neuen Pose nicht bestanden. Benutzen Sie sie nicht.</translation>
    </message>
    <message>
        <source>Saving check</source>
        <translation>Die Prüfung wird gespeichert</translation>
    </message>
    <message>
        <source>leave out {poses}</source>
        <translation>{poses} auslassen</translation>
    </message>
    <message>
        <source>restore {poses}</source>
        <translation>{poses} wieder einbeziehen</translation>
    </message>
    <message>
        <source>No pose was changed because the calibration is still being computed. Try again in a moment.</source>
        <translation>Es wurde keine Pose geändert, weil die Kalibrierung noch berechnet wird. Versuchen Sie es gleich noch einmal.</translation>
    </message>
    <message>
        <source>Saving settings</source>
        <translation>Die Einstellungen werden gespeichert</translation>
    </message>
    <message>
        <source>Reopening devices with the new mount</source>
        <translation>Die Geräte werden mit der neuen Montage neu geöffnet</translation>
    </message>
</context>
<context>
    <name>HeaderBar</name>
    <message>
        <source>Header</source>
        <translation>Kopfzeile</translation>
    </message>
    <message>
        <source>No session</source>
        <translation>Keine Sitzung</translation>
    </message>
    <message>
        <source>no devices chosen</source>
        <translation>keine Geräte gewählt</translation>
    </message>
    <message>
        <source>{} · not connected</source>
        <translation>{} · nicht verbunden</translation>
    </message>
    <message>
        <source>{} · {:.0f} Hz · {} lost</source>
        <translation>{} · {:.0f} Hz · {} verloren</translation>
    </message>
    <message>
        <source>virtual bench</source>
        <translation>virtueller Messplatz</translation>
    </message>
    <message>
        <source>replay of {}</source>
        <translation>Wiedergabe von {}</translation>
    </message>
</context>
<context>
    <name>HeatmapControls</name>
    <message>
        <source>Contact density</source>
        <translation>Kontaktdichte</translation>
    </message>
    <message>
        <source>Mean force</source>
        <translation>Mittlere Kraft</translation>
    </message>
    <message>
        <source>Peak force</source>
        <translation>Größte Kraft</translation>
    </message>
    <message>
        <source>Mean error</source>
        <translation>Mittlerer Fehler</translation>
    </message>
    <message>
        <source>Uncertainty (1 sigma)</source>
        <translation>Unsicherheit (1 Sigma)</translation>
    </message>
    <message>
        <source>Quantity</source>
        <translation>Größe</translation>
    </message>
    <message>
        <source>Meaning of the colours. Density: per mm2; forces: N; error and uncertainty: mm.</source>
        <translation>Bedeutung der Farben. Dichte: pro mm2; Kräfte: N; Fehler und Unsicherheit: mm.</translation>
    </message>
    <message>
        <source>contact count</source>
        <translation>Anzahl der Kontakte</translation>
    </message>
    <message>
        <source>contact time in s</source>
        <translation>Kontaktzeit in s</translation>
    </message>
    <message>
        <source>contacts per second</source>
        <translation>Kontakte pro Sekunde</translation>
    </message>
    <message>
        <source>Density normalisation</source>
        <translation>Normierung der Dichte</translation>
    </message>
    <message>
        <source>The integral of the density over the whole surface.</source>
        <translation>Das Integral der Dichte über die ganze Oberfläche.</translation>
    </message>
    <message>
        <source>Bandwidth in mm</source>
        <translation>Bandbreite in mm</translation>
    </message>
    <message>
        <source>Standard deviation of the Gaussian that spreads each contact along the surface, mm.</source>
        <translation>Standardabweichung der Gauß-Glocke, die jeden Kontakt entlang der Oberfläche verteilt, mm.</translation>
    </message>
    <message>
        <source>Force range in N</source>
        <translation>Kraftbereich in N</translation>
    </message>
    <message>
        <source>Use only contacts with a force in this range, N.</source>
        <translation>Nur Kontakte mit einer Kraft in diesem Bereich verwenden, N.</translation>
    </message>
    <message>
        <source>Weight by confidence</source>
        <translation>Nach Sicherheit gewichten</translation>
    </message>
    <message>
        <source>Give uncertain contacts less weight.</source>
        <translation>Unsichere Kontakte zählen weniger.</translation>
    </message>
    <message>
        <source>Compare side by side</source>
        <translation>Nebeneinander vergleichen</translation>
    </message>
    <message>
        <source>Show a second heatmap with the same view and colour scale.</source>
        <translation>Eine zweite Heatmap mit derselben Ansicht und Farbskala zeigen.</translation>
    </message>
    <message>
        <source>from the first contact</source>
        <translation>ab dem ersten Kontakt</translation>
    </message>
    <message>
        <source>from each one&apos;s beginning</source>
        <translation>ab dem jeweiligen Anfang</translation>
    </message>
    <message>
        <source>Time of two that are compared</source>
        <translation>Zeit der beiden Verglichenen</translation>
    </message>
    <message>
        <source>Whether both times count from where the probe was touched first, or from where each file begins.</source>
        <translation>Ob beide Zeiten ab der ersten Berührung der Sonde zählen oder ab dem Anfang der jeweiligen Datei.</translation>
    </message>
    <message>
        <source>How much later the second one is shown, s</source>
        <translation>Um wie viel später die zweite gezeigt wird, s</translation>
    </message>
    <message>
        <source>Moves the second one against the first in time.</source>
        <translation>Verschiebt die zweite gegen die erste in der Zeit.</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Open files</source>
        <translation>Dateien öffnen</translation>
    </message>
    <message>
        <source>Recordings with their calibration and probe, contacts, or verifications.</source>
        <translation>Aufzeichnungen mit Kalibrierung und Sonde, Kontakte oder Überprüfungen.</translation>
    </message>
    <message>
        <source>Open session</source>
        <translation>Sitzung öffnen</translation>
    </message>
    <message>
        <source>Latest recording and verification of a session.</source>
        <translation>Die neueste Aufzeichnung und Überprüfung einer Sitzung.</translation>
    </message>
    <message>
        <source>Picture</source>
        <translation>Bild</translation>
    </message>
    <message>
        <source>Save the current view from two sides as .png.</source>
        <translation>Die aktuelle Ansicht von zwei Seiten als .png speichern.</translation>
    </message>
    <message>
        <source>Film</source>
        <translation>Film</translation>
    </message>
    <message>
        <source>Save the time window at the chosen speed as .mp4 or .gif.</source>
        <translation>Das Zeitfenster im gewählten Tempo als .mp4 oder .gif speichern.</translation>
    </message>
    <message>
        <source>Mesh</source>
        <translation>Netz</translation>
    </message>
    <message>
        <source>Save the vertex values as .ply or .glb (glTF).</source>
        <translation>Die Werte an den Eckpunkten als .ply oder .glb (glTF) speichern.</translation>
    </message>
    <message>
        <source>Normalise to</source>
        <translation>Normieren auf</translation>
    </message>
    <message>
        <source>Bandwidth</source>
        <translation>Bandbreite</translation>
    </message>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>Zeit</translation>
    </message>
    <message>
        <source>Second one later by</source>
        <translation>Zweite später um</translation>
    </message>
    <message>
        <source>Heatmap</source>
        <translation>Heatmap</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>A peak is the largest force: nothing is weighed in it.</source>
        <translation>Eine Spitze ist die größte Kraft: Dabei wird nichts gewichtet.</translation>
    </message>
    <message>
        <source>What is shown does not say how sure its contacts are: locate them again.</source>
        <translation>Die gezeigten Daten sagen nicht, wie sicher ihre Kontakte sind: Orten Sie sie neu.</translation>
    </message>
    <message>
        <source>Forces unknown.</source>
        <translation>Kräfte unbekannt.</translation>
    </message>
    <message>
        <source>{low:.1f} to {high:.1f} N</source>
        <translation>{low:.1f} bis {high:.1f} N</translation>
    </message>
    <message>
        <source>Nothing is shown yet: open files or a session first.</source>
        <translation>Noch ist nichts zu sehen: Öffnen Sie zuerst Dateien oder eine Sitzung.</translation>
    </message>
    <message>
        <source>{title}: {percent}</source>
        <translation>{title}: {percent}</translation>
    </message>
</context>
<context>
    <name>HeatmapExport</name>
    <message>
        <source>Picture (*.png)</source>
        <translation>Bild (*.png)</translation>
    </message>
    <message>
        <source>PLY mesh (*.ply);;Binary glTF (*.glb)</source>
        <translation>PLY-Netz (*.ply);;Binäres glTF (*.glb)</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>MP4 film (*.mp4)</source>
        <translation>MP4-Film (*.mp4)</translation>
    </message>
    <message>
        <source>Animated GIF (*.gif)</source>
        <translation>Animiertes GIF (*.gif)</translation>
    </message>
    <message>
        <source>Saving {name}</source>
        <translation>{name} wird gespeichert</translation>
    </message>
    <message>
        <source>Saved {names}.</source>
        <translation>Gespeichert: {names}.</translation>
    </message>
    <message>
        <source> and </source>
        <translation> und </translation>
    </message>
</context>
<context>
    <name>HeatmapViewer</name>
    <message>
        <source>Drop files here: a recording (.mcap) with its calibration (.json) and probe (.ply),
contacts (.csv) with the probe, a verification (.json) with the probe,
or a session folder, which contains all of them.</source>
        <translation>Dateien hier ablegen: eine Aufzeichnung (.mcap) mit Kalibrierung (.json) und Sonde (.ply),
Kontakte (.csv) mit der Sonde, eine Überprüfung (.json) mit der Sonde,
oder einen Sitzungsordner, der alles enthält.</translation>
    </message>
    <message>
        <source>Play or pause the time window (P).</source>
        <translation>Das Zeitfenster abspielen oder anhalten (P).</translation>
    </message>
    <message>
        <source>Nothing is shown yet: open files or a session first.</source>
        <translation>Noch ist nichts zu sehen: Öffnen Sie zuerst Dateien oder eine Sitzung.</translation>
    </message>
    <message>
        <source>The picture is in the clipboard.</source>
        <translation>Das Bild ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>Opening</source>
        <translation>Wird geöffnet</translation>
    </message>
    <message>
        <source>Now add contact data: a recording, contacts or a verification.</source>
        <translation>Fügen Sie jetzt Kontaktdaten hinzu: eine Aufzeichnung, Kontakte oder eine Überprüfung.</translation>
    </message>
    <message>
        <source>Reloading</source>
        <translation>Wird neu geladen</translation>
    </message>
    <message>
        <source>Open session folder</source>
        <translation>Sitzungsordner öffnen</translation>
    </message>
    <message>
        <source>Open recordings, contacts or verifications with probe and calibration</source>
        <translation>Aufzeichnungen, Kontakte oder Überprüfungen mit Sonde und Kalibrierung öffnen</translation>
    </message>
    <message>
        <source>Supported files (*.mcap *.csv *.json *.ply *.stl *.obj *.off *.3mf *.glb *.gltf);;All files (*)</source>
        <translation>Unterstützte Dateien (*.mcap *.csv *.json *.ply *.stl *.obj *.off *.3mf *.glb *.gltf);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Computing heatmap</source>
        <translation>Die Heatmap wird berechnet</translation>
    </message>
    <message>
        <source>Heatmaps - contactbench</source>
        <translation>Heatmaps - contactbench</translation>
    </message>
</context>
<context>
    <name>HelpBook</name>
    <message>
        <source>Help</source>
        <translation>Hilfe</translation>
    </message>
    <message>
        <source>Search</source>
        <translation>Suchen</translation>
    </message>
    <message>
        <source>Search the help</source>
        <translation>In der Hilfe suchen</translation>
    </message>
    <message>
        <source>Pages</source>
        <translation>Seiten</translation>
    </message>
    <message>
        <source>No page has these words.</source>
        <translation>Keine Seite enthält diese Wörter.</translation>
    </message>
</context>
<context>
    <name>KnownCheckPanel</name>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Loading check</source>
        <translation>Prüfung lesen</translation>
    </message>
    <message>
        <source>Stopping recording</source>
        <translation>Aufnahme beenden</translation>
    </message>
    <message>
        <source>Starting recording</source>
        <translation>Aufnahme beginnen</translation>
    </message>
    <message>
        <source>Saving recording</source>
        <translation>Aufnahme sichern</translation>
    </message>
    <message>
        <source>Computing check</source>
        <translation>Prüfung berechnen</translation>
    </message>
    <message>
        <source>Passed</source>
        <translation>Bestanden</translation>
    </message>
    <message>
        <source>Inconclusive</source>
        <translation>Nicht zu entscheiden</translation>
    </message>
    <message>
        <source>Failed</source>
        <translation>Nicht bestanden</translation>
    </message>
    <message>
        <source>Outdated: check again</source>
        <translation>Veraltet: bitte neu prüfen</translation>
    </message>
</context>
<context>
    <name>LiveOutputsPanel</name>
    <message>
        <source>Address of {output}</source>
        <translation>Adresse: {output}</translation>
    </message>
    <message>
        <source>Allow other machines</source>
        <translation>Andere Rechner erlauben</translation>
    </message>
    <message>
        <source>Contacts are neither encrypted nor signed</source>
        <translation>Kontakte sind weder verschlüsselt noch signiert</translation>
    </message>
    <message>
        <source>Send contacts while devices are open, as contactbench run does.</source>
        <translation>Sendet Kontakte, solange Geräte offen sind, wie contactbench run.</translation>
    </message>
    <message>
        <source>{published:,} contacts sent, {lost:,} lost: the receiver is missing or too slow.</source>
        <translation>{published:,} Kontakte gesendet, {lost:,} verloren: Der Empfänger fehlt oder ist zu langsam.</translation>
    </message>
    <message>
        <source>{published:,} contacts sent.</source>
        <translation>{published:,} Kontakte gesendet.</translation>
    </message>
    <message>
        <source>Stop outputs</source>
        <translation>Ausgaben beenden</translation>
    </message>
    <message>
        <source>Start outputs</source>
        <translation>Ausgaben starten</translation>
    </message>
    <message>
        <source>Stopping outputs</source>
        <translation>Ausgaben werden beendet</translation>
    </message>
    <message>
        <source>Starting outputs</source>
        <translation>Ausgaben werden gestartet</translation>
    </message>
</context>
<context>
    <name>LiveView</name>
    <message>
        <source>Could not open this session&apos;s devices: {} Choose them again in step 1.</source>
        <translation>Die Geräte dieser Sitzung konnten nicht geöffnet werden: {} Wählen Sie sie in Schritt 1 neu.</translation>
    </message>
    <message>
        <source>Opening devices</source>
        <translation>Die Geräte werden geöffnet</translation>
    </message>
    <message>
        <source>no live samples</source>
        <translation>keine Messwerte</translation>
    </message>
    <message>
        <source>sensor {}</source>
        <translation>Sensor {}</translation>
    </message>
    <message>
        <source>poses {}</source>
        <translation>Posen {}</translation>
    </message>
    <message>
        <source>waiting</source>
        <translation>wartet</translation>
    </message>
    <message>
        <source>{:.0f} Hz</source>
        <translation>{:.0f} Hz</translation>
    </message>
</context>
<context>
    <name>MainWindow</name>
    <message>
        <source>Closing session</source>
        <translation>Die Sitzung wird geschlossen</translation>
    </message>
    <message>
        <source>done: {}</source>
        <translation>erledigt: {}</translation>
    </message>
    <message>
        <source>started</source>
        <translation>begonnen</translation>
    </message>
    <message>
        <source>Saving the current page</source>
        <translation>Die aktuelle Seite wird gespeichert</translation>
    </message>
    <message>
        <source>Step {} of {}: {}</source>
        <translation>Schritt {} von {}: {}</translation>
    </message>
</context>
<context>
    <name>MarkerTable</name>
    <message>
        <source>Marker</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>x  y  z</source>
        <translation>x  y  z</translation>
    </message>
    <message>
        <source>Touches</source>
        <translation>Berührt</translation>
    </message>
    <message>
        <source>Error</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>Position in the sensor frame S, mm</source>
        <translation>Lage im Sensorsystem S, mm</translation>
    </message>
    <message>
        <source>Accepted and required touches</source>
        <translation>Gezählte und nötige Berührungen</translation>
    </message>
    <message>
        <source>Mean error and largest error, mm</source>
        <translation>Mittlerer und größter Fehler, mm</translation>
    </message>
    <message>
        <source>Markers</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>{name}: x {x} mm, y {y} mm, z {z} mm</source>
        <translation>{name}: x {x} mm, y {y} mm, z {z} mm</translation>
    </message>
    <message>
        <source>open</source>
        <translation>offen</translation>
    </message>
    <message>
        <source>next</source>
        <translation>nächster</translation>
    </message>
    <message>
        <source>done</source>
        <translation>erledigt</translation>
    </message>
    <message>
        <source>too far off</source>
        <translation>zu weit weg</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>ausgelassen</translation>
    </message>
</context>
<context>
    <name>MarkersPanel</name>
    <message>
        <source>No markers yet. Distribute some over the probe, click on it, or import measured positions.</source>
        <translation>Noch keine Marker. Verteilen Sie welche auf der Sonde, klicken Sie darauf, oder importieren Sie gemessene Positionen.</translation>
    </message>
    <message>
        <source>Area for markers</source>
        <translation>Bereich für Marker</translation>
    </message>
    <message>
        <source>Place on</source>
        <translation>Setzen auf</translation>
    </message>
    <message>
        <source>Number of markers</source>
        <translation>Anzahl der Marker</translation>
    </message>
    <message>
        <source>Distribute evenly</source>
        <translation>Gleichmäßig verteilen</translation>
    </message>
    <message>
        <source>Grid spacing, mm</source>
        <translation>Abstand der Gitterlinien, mm</translation>
    </message>
    <message>
        <source>Create grid</source>
        <translation>Gitter anlegen</translation>
    </message>
    <message>
        <source>Click to place</source>
        <translation>Durch Klicken setzen</translation>
    </message>
    <message>
        <source>Click the probe to add a marker; if a marker is selected, the click moves it</source>
        <translation>Klick auf die Sonde setzt einen Marker; ein gewählter Marker wird stattdessen verschoben</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Import…</source>
        <translation>Importieren…</translation>
    </message>
    <message>
        <source>Save as…</source>
        <translation>Speichern unter…</translation>
    </message>
    <message>
        <source>Snap to surface</source>
        <translation>Auf die Oberfläche setzen</translation>
    </message>
    <message>
        <source>Move every marker to the nearest point on the probe</source>
        <translation>Jeden Marker auf den nächsten Punkt der Sonde setzen</translation>
    </message>
    <message>
        <source>Marker {axis} in the sensor frame S, mm</source>
        <translation>{axis} des Markers im Sensorsystem S, mm</translation>
    </message>
    <message>
        <source>Add a marker at these coordinates</source>
        <translation>Einen Marker an diesen Koordinaten hinzufügen</translation>
    </message>
    <message>
        <source>region {rank}</source>
        <translation>Region {rank}</translation>
    </message>
    <message>
        <source>whole probe</source>
        <translation>ganze Sonde</translation>
    </message>
    <message>
        <source>Add marker</source>
        <translation>Marker hinzufügen</translation>
    </message>
    <message>
        <source>Move marker {name}</source>
        <translation>Marker {name} verschieben</translation>
    </message>
    <message>
        <source>Remove markers</source>
        <translation>Marker entfernen</translation>
    </message>
    <message>
        <source>Rename marker {name}</source>
        <translation>Marker {name} umbenennen</translation>
    </message>
    <message>
        <source>Place markers</source>
        <translation>Marker setzen</translation>
    </message>
    <message>
        <source>Snap markers to surface</source>
        <translation>Marker auf die Oberfläche setzen</translation>
    </message>
    <message>
        <source>Import markers</source>
        <translation>Marker importieren</translation>
    </message>
    <message>
        <source>Saving markers</source>
        <translation>Die Marker werden gespeichert</translation>
    </message>
    <message>
        <source>Markers saved in {file}.</source>
        <translation>Marker in {file} gespeichert.</translation>
    </message>
    <message>
        <source>Marker tables (*.csv)</source>
        <translation>Tabellen mit Markern (*.csv)</translation>
    </message>
    <message>
        <source>Save markers</source>
        <translation>Marker speichern</translation>
    </message>
</context>
<context>
    <name>Menus</name>
    <message>
        <source>&amp;File</source>
        <translation>&amp;Datei</translation>
    </message>
    <message>
        <source>&amp;New session…</source>
        <translation>&amp;Neue Sitzung…</translation>
    </message>
    <message>
        <source>Try the &amp;virtual bench</source>
        <translation>&amp;Virtuellen Messplatz ausprobieren</translation>
    </message>
    <message>
        <source>&amp;Open session…</source>
        <translation>Sitzung ö&amp;ffnen…</translation>
    </message>
    <message>
        <source>&amp;Recent sessions</source>
        <translation>&amp;Zuletzt benutzte Sitzungen</translation>
    </message>
    <message>
        <source>&amp;Reload session</source>
        <translation>Sitzung &amp;neu laden</translation>
    </message>
    <message>
        <source>&amp;Close session</source>
        <translation>Sitzung s&amp;chließen</translation>
    </message>
    <message>
        <source>Save &amp;diagnostics…</source>
        <translation>&amp;Diagnose speichern…</translation>
    </message>
    <message>
        <source>&amp;Quit</source>
        <translation>&amp;Beenden</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>&amp;Bearbeiten</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>&amp;Copy the picture of the 3D view</source>
        <translation>Bild der 3D-Ansicht &amp;kopieren</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>&amp;Ansicht</translation>
    </message>
    <message>
        <source>&amp;Reset layout</source>
        <translation>&amp;Anordnung zurücksetzen</translation>
    </message>
    <message>
        <source>Follow &amp;system</source>
        <translation>Wie &amp;System</translation>
    </message>
    <message>
        <source>&amp;Light</source>
        <translation>&amp;Hell</translation>
    </message>
    <message>
        <source>&amp;Dark</source>
        <translation>&amp;Dunkel</translation>
    </message>
    <message>
        <source>&amp;Theme</source>
        <translation>&amp;Farbschema</translation>
    </message>
    <message>
        <source>Follow s&amp;ystem</source>
        <translation>Wie S&amp;ystem</translation>
    </message>
    <message>
        <source>Lan&amp;guage</source>
        <translation>S&amp;prache</translation>
    </message>
    <message>
        <source>&amp;Full screen</source>
        <translation>&amp;Vollbild</translation>
    </message>
    <message>
        <source>&amp;Steps</source>
        <translation>&amp;Schritte</translation>
    </message>
    <message>
        <source>&amp;Tools</source>
        <translation>&amp;Werkzeuge</translation>
    </message>
    <message>
        <source>&amp;Heatmap viewer</source>
        <translation>&amp;Heatmap-Betrachter</translation>
    </message>
    <message>
        <source>&amp;Motion control on the virtual bench</source>
        <translation>&amp;Bewegungsregelung am virtuellen Messplatz</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>&amp;Hilfe</translation>
    </message>
    <message>
        <source>&amp;This page</source>
        <translation>&amp;Diese Seite</translation>
    </message>
    <message>
        <source>&amp;Tutorial</source>
        <translation>&amp;Einführung</translation>
    </message>
    <message>
        <source>&amp;Documentation</source>
        <translation>&amp;Dokumentation</translation>
    </message>
    <message>
        <source>&amp;Shortcuts</source>
        <translation>&amp;Tastenkürzel</translation>
    </message>
    <message>
        <source>&amp;Log</source>
        <translation>&amp;Protokoll</translation>
    </message>
    <message>
        <source>&amp;About contactbench</source>
        <translation>&amp;Über contactbench</translation>
    </message>
    <message>
        <source>The picture of the 3D view is in the clipboard.</source>
        <translation>Das Bild der 3D-Ansicht ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>Longest UI stall {:.0f} ms; 99th percentile {:.0f} ms.</source>
        <translation>Längste Unterbrechung der Oberfläche {:.0f} ms; 99. Perzentil {:.0f} ms.</translation>
    </message>
    <message>
        <source>Logging is off.</source>
        <translation>Es wird kein Protokoll geführt.</translation>
    </message>
    <message>
        <source>Log</source>
        <translation>Protokoll</translation>
    </message>
    <message>
        <source>Heatmap viewer</source>
        <translation>Heatmap-Betrachter</translation>
    </message>
    <message>
        <source>Motion control on the virtual bench</source>
        <translation>Bewegungsregelung am virtuellen Messplatz</translation>
    </message>
    <message>
        <source>Save diagnostics</source>
        <translation>Diagnose speichern</translation>
    </message>
    <message>
        <source>Zip files (*.zip)</source>
        <translation>Zip-Dateien (*.zip)</translation>
    </message>
    <message>
        <source>Saving diagnostics</source>
        <translation>Die Diagnose wird gespeichert</translation>
    </message>
    <message>
        <source>Diagnostics saved as {}. They contain no recordings, meshes or names.</source>
        <translation>Diagnose als {} gespeichert. Sie enthält keine Aufzeichnungen, Netze oder Namen.</translation>
    </message>
    <message>
        <source>None yet</source>
        <translation>Noch keine</translation>
    </message>
    <message>
        <source>The language changes after a restart of contactbench.</source>
        <translation>Die Sprache wechselt nach einem Neustart von contactbench.</translation>
    </message>
</context>
<context>
    <name>MeshReport</name>
    <message>
        <source>No problems found that affect contacts.</source>
        <translation>Keine Probleme gefunden, die Kontakte beeinträchtigen.</translation>
    </message>
    <message>
        <source>Fault</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>Prüfen</translation>
    </message>
    <message>
        <source>Note</source>
        <translation>Hinweis</translation>
    </message>
    <message>
        <source>Good</source>
        <translation>Gut</translation>
    </message>
    <message>
        <source>Show less</source>
        <translation>Weniger zeigen</translation>
    </message>
    <message>
        <source>Show {} more</source>
        <translation>{} weitere zeigen</translation>
    </message>
</context>
<context>
    <name>MeshSection</name>
    <message>
        <source>1  Mesh</source>
        <translation>1  Netz</translation>
    </message>
    <message>
        <source>Choose mesh…</source>
        <translation>Netz wählen…</translation>
    </message>
    <message>
        <source>STL, PLY, OBJ, OFF or 3MF; you can also drop a file on the window</source>
        <translation>STL, PLY, OBJ, OFF oder 3MF; Sie können eine Datei auch auf das Fenster ziehen</translation>
    </message>
    <message>
        <source>Use virtual bench housing</source>
        <translation>Gehäuse des virtuellen Messplatzes nutzen</translation>
    </message>
    <message>
        <source>Drop the probe mesh from CAD or a scanner here, or choose a file.</source>
        <translation>Ziehen Sie das Netz der Sonde aus CAD oder vom Scanner hierher, oder wählen Sie eine Datei.</translation>
    </message>
    <message>
        <source>How long is the probe? The file does not state its unit.</source>
        <translation>Wie lang ist die Sonde? Die Datei gibt keine Einheit an.</translation>
    </message>
    <message>
        <source>{:.4g} mm long ({})</source>
        <translation>{:.4g} mm lang ({})</translation>
    </message>
</context>
<context>
    <name>MessageList</name>
    <message>
        <source>Messages</source>
        <translation>Meldungen</translation>
    </message>
    <message>
        <source>Message details</source>
        <translation>Einzelheiten der Meldung</translation>
    </message>
    <message>
        <source>All</source>
        <translation>Alle</translation>
    </message>
    <message>
        <source>Warnings</source>
        <translation>Warnungen</translation>
    </message>
    <message>
        <source>Errors</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Filter: all messages, warnings and errors, or errors only</source>
        <translation>Filter: alle Meldungen, Warnungen und Fehler, oder nur Fehler</translation>
    </message>
    <message>
        <source>No messages.</source>
        <translation>Keine Meldungen.</translation>
    </message>
    <message>
        <source>Copy selected messages</source>
        <translation>Gewählte Meldungen kopieren</translation>
    </message>
    <message>
        <source>Message filter</source>
        <translation>Meldungsfilter</translation>
    </message>
    <message>
        <source>Details</source>
        <translation>Einzelheiten</translation>
    </message>
    <message>
        <source>Show details of the selected message</source>
        <translation>Einzelheiten der gewählten Meldung zeigen</translation>
    </message>
    <message>
        <source>Copy selected messages with details</source>
        <translation>Die gewählten Meldungen mit ihren Einzelheiten kopieren</translation>
    </message>
    <message>
        <source>Copy messages</source>
        <translation>Meldungen kopieren</translation>
    </message>
    <message>
        <source>Note</source>
        <translation>Hinweis</translation>
    </message>
    <message>
        <source>Good</source>
        <translation>Gut</translation>
    </message>
    <message>
        <source>Warning</source>
        <translation>Warnung</translation>
    </message>
    <message>
        <source>Error</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source> ({} times)</source>
        <translation> ({}-mal)</translation>
    </message>
    <message>
        <source>No further details.</source>
        <translation>Keine weiteren Einzelheiten.</translation>
    </message>
    <message>
        <source>Select a message.</source>
        <translation>Wählen Sie eine Meldung.</translation>
    </message>
</context>
<context>
    <name>MessageRouter</name>
    <message>
        <source>Unexpected error: {}. Your session is safe. Try again. If the error persists, save diagnostics (File menu) and send them to your support contact.</source>
        <translation>Unerwarteter Fehler: {}. Ihre Sitzung ist sicher. Versuchen Sie es noch einmal. Tritt der Fehler wieder auf, speichern Sie die Diagnose (Menü Datei) und senden Sie sie an Ihre Ansprechperson.</translation>
    </message>
    <message>
        <source>{}: {}</source>
        <translation>{}: {}</translation>
    </message>
</context>
<context>
    <name>MotionControls</name>
    <message>
        <source>Elfin3 arm</source>
        <translation>Elfin3-Arm</translation>
    </message>
    <message>
        <source>stiff mount</source>
        <translation>steife Halterung</translation>
    </message>
    <message>
        <source>Robot</source>
        <translation>Roboter</translation>
    </message>
    <message>
        <source>Both are simulated; no real hardware moves.</source>
        <translation>Beide sind simuliert; keine echte Hardware bewegt sich.</translation>
    </message>
    <message>
        <source>rocks along the face</source>
        <translation>kippt längs der Fläche</translation>
    </message>
    <message>
        <source>rocks across the face</source>
        <translation>kippt quer zur Fläche</translation>
    </message>
    <message>
        <source>moves up and down</source>
        <translation>bewegt sich auf und ab</translation>
    </message>
    <message>
        <source>at rest</source>
        <translation>ruht</translation>
    </message>
    <message>
        <source>Phantom</source>
        <translation>Phantom</translation>
    </message>
    <message>
        <source>Motion of the soft phantom under the probe.</source>
        <translation>Bewegung des weichen Phantoms unter der Sonde.</translation>
    </message>
    <message>
        <source>{seconds:g} s</source>
        <translation>{seconds:g} s</translation>
    </message>
    <message>
        <source>Period</source>
        <translation>Periode</translation>
    </message>
    <message>
        <source>Period T of the phantom&apos;s motion.</source>
        <translation>Periode T der Bewegung des Phantoms.</translation>
    </message>
    <message>
        <source>from the bundle</source>
        <translation>aus dem Paket</translation>
    </message>
    <message>
        <source>predictive</source>
        <translation>vorausschauend</translation>
    </message>
    <message>
        <source>basic</source>
        <translation>einfach</translation>
    </message>
    <message>
        <source>Control</source>
        <translation>Regelung</translation>
    </message>
    <message>
        <source>Predictive: estimates the phantom&apos;s motion and leads it. Basic: force and position only.</source>
        <translation>Vorausschauend: schätzt die Bewegung des Phantoms und nimmt sie vorweg. Einfach: nur Kraft und Position.</translation>
    </message>
    <message>
        <source>Amplitude of the phantom&apos;s motion to each side.</source>
        <translation>Ausschlag des Phantoms, nach jeder Seite.</translation>
    </message>
    <message>
        <source>Amplitude</source>
        <translation>Amplitude</translation>
    </message>
    <message>
        <source>Controller state</source>
        <translation>Zustand der Regelung</translation>
    </message>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>Angle to the phantom</source>
        <translation>Winkel zum Phantom</translation>
    </message>
    <message>
        <source>How fast its time goes, against the clock: 1.00 is real time. Measured over the last frames.</source>
        <translation>Wie schnell die Zeit der Simulation gegen die Uhr läuft: 1.00 ist Echtzeit. Über die letzten Bilder gemessen.</translation>
    </message>
    <message>
        <source>Use a bundle of the open session in its current state.</source>
        <translation>Ein Paket aus dem jetzigen Stand der offenen Sitzung nutzen.</translation>
    </message>
    <message>
        <source>Use session</source>
        <translation>Sitzung nutzen</translation>
    </message>
    <message>
        <source>An exported folder or zip file.</source>
        <translation>Ein exportierter Ordner oder eine exportierte Zip-Datei.</translation>
    </message>
    <message>
        <source>Open bundle</source>
        <translation>Paket öffnen</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Starten</translation>
    </message>
    <message>
        <source>Retract the probe and stop (Esc).</source>
        <translation>Die Sonde zurückziehen und anhalten (Esc).</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Stopp</translation>
    </message>
    <message>
        <source>Nothing moves any more; it is about to end.</source>
        <translation>Nichts bewegt sich mehr; der Lauf endet gleich.</translation>
    </message>
    <message>
        <source>No bundle</source>
        <translation>Kein Paket</translation>
    </message>
    <message>
        <source>Choose the bundle that is to be run.</source>
        <translation>Wählen Sie das Paket, das laufen soll.</translation>
    </message>
    <message>
        <source>Opening the bundle</source>
        <translation>Das Paket wird geöffnet</translation>
    </message>
    <message>
        <source>Ready</source>
        <translation>Bereit</translation>
    </message>
    <message>
        <source>Nothing moves until you press Start.</source>
        <translation>Nichts bewegt sich, bis Sie Starten drücken.</translation>
    </message>
    <message>
        <source>Starting</source>
        <translation>Startet</translation>
    </message>
    <message>
        <source>The virtual robot is being made.</source>
        <translation>Der virtuelle Roboter wird angelegt.</translation>
    </message>
    <message>
        <source>Stopping</source>
        <translation>Hält an</translation>
    </message>
    <message>
        <source>The probe leaves the phantom, then stands still.</source>
        <translation>Die Sonde verlässt das Phantom und steht dann still.</translation>
    </message>
    <message>
        <source>Ended</source>
        <translation>Beendet</translation>
    </message>
    <message>
        <source>The probe stands still; nothing moves any more.</source>
        <translation>Die Sonde steht still; nichts bewegt sich mehr.</translation>
    </message>
    <message>
        <source>Failed</source>
        <translation>Fehlgeschlagen</translation>
    </message>
    <message>
        <source>Nothing moves any more; the message says why.</source>
        <translation>Nichts bewegt sich mehr; die Meldung sagt, warum.</translation>
    </message>
    <message>
        <source>Motion control</source>
        <translation>Bewegungsregelung</translation>
    </message>
    <message>
        <source>force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>angle to the phantom</source>
        <translation>Winkel zum Phantom</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>°</source>
        <translation>°</translation>
    </message>
    <message>
        <source>{:z.1f} N</source>
        <translation>{:z.1f} N</translation>
    </message>
    <message>
        <source>{:.1f}°</source>
        <translation>{:.1f}°</translation>
    </message>
    <message>
        <source>Pace: –</source>
        <translation>Tempo: –</translation>
    </message>
    <message>
        <source>Pace: {pace:.2f} of real time</source>
        <translation>Tempo: {pace:.2f} der Echtzeit</translation>
    </message>
    <message>
        <source>Pace: {pace:.2f} of real time: this computer is too slow</source>
        <translation>Tempo: {pace:.2f} der Echtzeit: Dieser Rechner ist zu langsam</translation>
    </message>
    <message>
        <source>{time:.1f} s  {state}: {why}</source>
        <translation>{time:.1f} s  {state}: {why}</translation>
    </message>
    <message>
        <source>Approaching</source>
        <translation>Nähert sich</translation>
    </message>
    <message>
        <source>The probe is slowly approaching the phantom.</source>
        <translation>Die Sonde nähert sich langsam dem Phantom.</translation>
    </message>
    <message>
        <source>In contact</source>
        <translation>In Kontakt</translation>
    </message>
    <message>
        <source>The force rises, then the stiffness is estimated.</source>
        <translation>Die Kraft steigt, dann wird die Steifigkeit geschätzt.</translation>
    </message>
    <message>
        <source>Tracking</source>
        <translation>Folgt</translation>
    </message>
    <message>
        <source>Keeps its force and stays perpendicular.</source>
        <translation>Hält die Kraft und bleibt senkrecht.</translation>
    </message>
    <message>
        <source>Holding</source>
        <translation>Hält an</translation>
    </message>
    <message>
        <source>Waiting until the readings are reliable again.</source>
        <translation>Wartet, bis die Messwerte wieder verlässlich sind.</translation>
    </message>
    <message>
        <source>Retracting</source>
        <translation>Zieht sich zurück</translation>
    </message>
    <message>
        <source>The probe is leaving the phantom.</source>
        <translation>Die Sonde löst sich vom Phantom.</translation>
    </message>
    <message>
        <source>Stopped</source>
        <translation>Angehalten</translation>
    </message>
</context>
<context>
    <name>MotionWindow</name>
    <message>
        <source>Choose a bundle, then press Start. Everything is simulated; no real hardware moves.</source>
        <translation>Wählen Sie ein Paket und drücken Sie Starten. Alles ist simuliert; keine echte Hardware bewegt sich.</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Stopp</translation>
    </message>
    <message>
        <source>This page</source>
        <translation>Diese Seite</translation>
    </message>
    <message>
        <source>No session is open. Open one or choose a bundle.</source>
        <translation>Keine Sitzung ist offen. Öffnen Sie eine, oder wählen Sie ein Paket.</translation>
    </message>
    <message>
        <source>Creating bundle</source>
        <translation>Ein Paket wird erstellt</translation>
    </message>
    <message>
        <source>Opening bundle</source>
        <translation>Ein Paket wird geöffnet</translation>
    </message>
    <message>
        <source>{name}: {facets:,} facets.</source>
        <translation>{name}: {facets:,} Facetten.</translation>
    </message>
    <message>
        <source>Not verified: for trials only.</source>
        <translation>Nicht überprüft: nur für Versuche.</translation>
    </message>
    <message>
        <source>The bundle does not state the sensor&apos;s mounting; no rotation is assumed.</source>
        <translation>Das Paket gibt die Montage des Sensors nicht an; es wird keine Drehung angenommen.</translation>
    </message>
    <message>
        <source>The bundle has no gains; the defaults for its probe are used.</source>
        <translation>Das Paket hat keine Verstärkungen; die Standardwerte für seine Sonde werden verwendet.</translation>
    </message>
    <message>
        <source>Contact force {force:g} N.</source>
        <translation>Kontaktkraft {force:g} N.</translation>
    </message>
    <message>
        <source>Open bundle</source>
        <translation>Ein Paket öffnen</translation>
    </message>
    <message>
        <source>Bundles (*.zip contactbench.json);;All files (*)</source>
        <translation>Pakete (*.zip contactbench.json);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Tracked for {seconds:.0f} s at {low:.1f} to {high:.1f} N; mean angle error {within:.1f}° along the face and {out:.1f}° across it.</source>
        <translation>{seconds:.0f} s lang gefolgt mit {low:.1f} bis {high:.1f} N; mittlerer Winkelfehler {within:.1f}° längs der Fläche und {out:.1f}° quer dazu.</translation>
    </message>
</context>
<context>
    <name>NewestMessage</name>
    <message>
        <source>Newest message</source>
        <translation>Neueste Meldung</translation>
    </message>
</context>
<context>
    <name>Pages</name>
    <message>
        <source>Checking session</source>
        <translation>Die Sitzung wird geprüft</translation>
    </message>
</context>
<context>
    <name>PayloadPanel</name>
    <message>
        <source>Robot</source>
        <translation>Roboter</translation>
    </message>
    <message>
        <source>Sensor origin on the flange, {axis}</source>
        <translation>Ursprung des Sensors am Flansch, {axis}</translation>
    </message>
    <message>
        <source>Mass of the sensor</source>
        <translation>Masse des Sensors</translation>
    </message>
    <message>
        <source>With its adapters; the sensor does not feel its own weight</source>
        <translation>Mit seinen Adaptern; der Sensor spürt sein eigenes Gewicht nicht</translation>
    </message>
    <message>
        <source>Centre of mass of the sensor, {axis}</source>
        <translation>Schwerpunkt des Sensors, {axis}</translation>
    </message>
    <message>
        <source>Payload for the robot&apos;s controller</source>
        <translation>Nutzlast für die Robotersteuerung</translation>
    </message>
    <message>
        <source>Copy payload</source>
        <translation>Nutzlast kopieren</translation>
    </message>
    <message>
        <source>Sensor at</source>
        <translation>Sensor bei</translation>
    </message>
    <message>
        <source>Sensor mass</source>
        <translation>Sensormasse</translation>
    </message>
    <message>
        <source>Its centre</source>
        <translation>Schwerpunkt</translation>
    </message>
    <message>
        <source>Calibrate first.</source>
        <translation>Kalibrieren Sie zuerst.</translation>
    </message>
    <message>
        <source>Too unsure to tell a robot: calibrate with poses that tilt farther.</source>
        <translation>Zu ungenau für einen Roboter: Kalibrieren Sie mit stärker geneigten Posen.</translation>
    </message>
    <message>
        <source>Standard deviation {mass:.1f} g and at most {centre:.1f} mm.</source>
        <translation>Standardabweichung {mass:.1f} g und höchstens {centre:.1f} mm.</translation>
    </message>
    <message>
        <source>The sensor&apos;s own mass is not included.</source>
        <translation>Die Masse des Sensors selbst ist nicht enthalten.</translation>
    </message>
    <message>
        <source>The sensor is taken as not turned on the flange.</source>
        <translation>Der Sensor gilt als nicht gegen den Flansch gedreht.</translation>
    </message>
    <message>
        <source>The payload is in the clipboard.</source>
        <translation>Die Nutzlast ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>Payload</source>
        <translation>Nutzlast</translation>
    </message>
</context>
<context>
    <name>Picture</name>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>target</source>
        <translation>Sollwert</translation>
    </message>
    <message>
        <source>angle along the face</source>
        <translation>Winkel längs der Fläche</translation>
    </message>
    <message>
        <source>across the face</source>
        <translation>quer zur Fläche</translation>
    </message>
    <message>
        <source>Angle to the phantom</source>
        <translation>Winkel zum Phantom</translation>
    </message>
</context>
<context>
    <name>PlaceSection</name>
    <message>
        <source>3  Alignment with sensor</source>
        <translation>3  Ausrichtung am Sensor</translation>
    </message>
    <message>
        <source>Aligning mesh</source>
        <translation>Das Netz wird ausgerichtet</translation>
    </message>
</context>
<context>
    <name>PointPanel</name>
    <message>
        <source>Known point</source>
        <translation>Bekannter Punkt</translation>
    </message>
    <message>
        <source>Press one marker on the side of the probe with a finger. This reveals wrong torque signs or units, and a probe rotated on the sensor.</source>
        <translation>Drücken Sie mit dem Finger auf einen Marker an der Seite der Sonde. So zeigen sich falsche Vorzeichen oder Einheiten der Drehmomente und eine auf dem Sensor verdrehte Sonde.</translation>
    </message>
    <message>
        <source>Marker</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>Record press</source>
        <translation>Druck aufnehmen</translation>
    </message>
    <message>
        <source>Place a marker on the Markers tab first.</source>
        <translation>Setzen Sie zuerst unter Marker einen Marker.</translation>
    </message>
</context>
<context>
    <name>PointTable</name>
    <message>
        <source>on the mesh</source>
        <translation>auf dem Netz</translation>
    </message>
    <message>
        <source>Matching points: on the mesh and in the sensor frame, mm</source>
        <translation>Punktpaare: auf dem Netz und im Sensorsystem, in mm</translation>
    </message>
    <message>
        <source>Enter each point&apos;s position in the sensor frame, mm</source>
        <translation>Geben Sie die Lage jedes Punkts im Sensorsystem ein, mm</translation>
    </message>
    <message>
        <source>Remove this point</source>
        <translation>Diesen Punkt entfernen</translation>
    </message>
</context>
<context>
    <name>PoseModel</name>
    <message>
        <source>Deviation of the reading from the fit to all poses, in standard deviations. About 1 is normal; check poses above 3.</source>
        <translation>Restabweichung: Abstand des Messwerts von der Anpassung an alle Posen, in Standardabweichungen. Etwa 1 ist normal; über 3 lohnt ein Blick.</translation>
    </message>
    <message>
        <source>Pose</source>
        <translation>Pose</translation>
    </message>
    <message>
        <source>Tilt</source>
        <translation>Neigung</translation>
    </message>
    <message>
        <source>Residual</source>
        <translation>Abw. (σ)</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>{name}, {words}, residual {sigmas} sigma, {state}</source>
        <translation>{name}, {words}, Restabweichung {sigmas} Sigma, {state}</translation>
    </message>
    <message>
        <source>force {force:.1f} sigma, torque {torque:.1f} sigma</source>
        <translation>Kraft {force:.1f} Sigma, Moment {torque:.1f} Sigma</translation>
    </message>
    <message>
        <source>From the interrupted recording.</source>
        <translation>Aus der unterbrochenen Aufzeichnung.</translation>
    </message>
    <message>
        <source>captured</source>
        <translation>aufgenommen</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>ausgelassen</translation>
    </message>
    <message>
        <source>rejected</source>
        <translation>abgelehnt</translation>
    </message>
</context>
<context>
    <name>PoseSource</name>
    <message>
        <source>Orientation</source>
        <translation>Orientierung</translation>
    </message>
    <message>
        <source>Robot address</source>
        <translation>Adresse des Roboters</translation>
    </message>
    <message>
        <source>Pose file</source>
        <translation>Datei mit Posen</translation>
    </message>
    <message>
        <source>Poses (*.csv);;All files (*)</source>
        <translation>Posen (*.csv);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Flange rotation about {axis}</source>
        <translation>Drehung des Flanschs um {axis}</translation>
    </message>
    <message>
        <source>From the sensor source</source>
        <translation>Aus der Sensorquelle</translation>
    </message>
    <message>
        <source>Robot</source>
        <translation>Roboter</translation>
    </message>
    <message>
        <source>Stationary</source>
        <translation>Feststehend</translation>
    </message>
    <message>
        <source>None</source>
        <translation>Keine</translation>
    </message>
    <message>
        <source>A virtual bench and most recordings include the orientation.</source>
        <translation>Ein virtueller Messplatz und die meisten Aufzeichnungen liefern auch die Orientierung.</translation>
    </message>
    <message>
        <source>Gravity cannot be calibrated without an orientation. Only raw readings are shown.</source>
        <translation>Ohne Orientierung kann die Schwerkraft nicht kalibriert werden. Nur rohe Messwerte werden gezeigt.</translation>
    </message>
    <message>
        <source>This sensor does not report its orientation. Choose the robot that moves it.</source>
        <translation>Dieser Sensor gibt seine Orientierung nicht an. Wählen Sie den Roboter, der ihn bewegt.</translation>
    </message>
    <message>
        <source>Choose a pose file.</source>
        <translation>Wählen Sie eine Datei mit Posen.</translation>
    </message>
</context>
<context>
    <name>ProbePage</name>
    <message>
        <source>Probe mesh</source>
        <translation>Netz der Sonde</translation>
    </message>
    <message>
        <source>Meshes</source>
        <translation>Netze</translation>
    </message>
    <message>
        <source>Probe</source>
        <translation>Sonde</translation>
    </message>
    <message>
        <source>Saving probe</source>
        <translation>Die Sonde wird behalten</translation>
    </message>
    <message>
        <source>Next: Regions</source>
        <translation>Weiter: Regionen</translation>
    </message>
    <message>
        <source>Choose mesh…</source>
        <translation>Netz wählen…</translation>
    </message>
    <message>
        <source>Enter probe length (1)</source>
        <translation>Länge der Sonde angeben (1)</translation>
    </message>
    <message>
        <source>Create outer surface</source>
        <translation>Außenfläche machen</translation>
    </message>
    <message>
        <source>Align with sensor (3)</source>
        <translation>Am Sensor ausrichten (3)</translation>
    </message>
    <message>
        <source>Prepare probe</source>
        <translation>Sonde vorbereiten</translation>
    </message>
    <message>
        <source>Use this probe</source>
        <translation>Diese Sonde nutzen</translation>
    </message>
    <message>
        <source>{} from the outer surface.</source>
        <translation>{} von der Außenfläche.</translation>
    </message>
    <message>
        <source>Probe of this session.</source>
        <translation>Die Sonde der Sitzung.</translation>
    </message>
</context>
<context>
    <name>ProbeStages</name>
    <message>
        <source>deviation, mm</source>
        <translation>Abweichung, mm</translation>
    </message>
    <message>
        <source>keep the probe&apos;s draft</source>
        <translation>Entwurf der Sonde sichern</translation>
    </message>
    <message>
        <source>Reading {}</source>
        <translation>{} wird gelesen</translation>
    </message>
    <message>
        <source>Creating the virtual bench housing</source>
        <translation>Das Gehäuse des virtuellen Messplatzes wird erstellt</translation>
    </message>
    <message>
        <source>take the mesh {}</source>
        <translation>Netz {} nehmen</translation>
    </message>
    <message>
        <source>Checking the mesh in its unit</source>
        <translation>Das Netz wird in seiner Einheit geprüft</translation>
    </message>
    <message>
        <source>say the mesh&apos;s unit</source>
        <translation>Einheit des Netzes angeben</translation>
    </message>
    <message>
        <source>choose how the outer surface is made</source>
        <translation>Außenfläche einstellen</translation>
    </message>
    <message>
        <source>Creating outer surface</source>
        <translation>Die Außenfläche wird erstellt</translation>
    </message>
    <message>
        <source>place the mesh</source>
        <translation>Netz platzieren</translation>
    </message>
    <message>
        <source>Aligning mesh</source>
        <translation>Das Netz wird ausgerichtet</translation>
    </message>
    <message>
        <source>Comparing facet counts</source>
        <translation>Anzahlen von Facetten werden verglichen</translation>
    </message>
    <message>
        <source>choose the number of facets</source>
        <translation>Facettenzahl wählen</translation>
    </message>
    <message>
        <source>Preparing probe</source>
        <translation>Die Sonde wird vorbereitet</translation>
    </message>
    <message>
        <source>use probe</source>
        <translation>die Sonde nutzen</translation>
    </message>
    <message>
        <source>The probe with {:,} facets is in use. Next: regions or verification.</source>
        <translation>Die Sonde mit {:,} Facetten ist in Gebrauch. Als Nächstes: Regionen oder Überprüfung.</translation>
    </message>
    <message>
        <source>Opening probe</source>
        <translation>Die Sonde wird geöffnet</translation>
    </message>
</context>
<context>
    <name>ProbeWorker</name>
    <message>
        <source>Stopped. Nothing was changed.</source>
        <translation>Angehalten. Nichts wurde geändert.</translation>
    </message>
    <message>
        <source>Unexpected error ({}). Nothing was changed. Try again.</source>
        <translation>Unerwarteter Fehler ({}). Nichts wurde geändert. Versuchen Sie es noch einmal.</translation>
    </message>
</context>
<context>
    <name>ProgressStrip</name>
    <message>
        <source>Progress</source>
        <translation>Fortschritt</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Stop this task; finished results are kept</source>
        <translation>Diese Arbeit anhalten; fertige Ergebnisse bleiben erhalten</translation>
    </message>
    <message>
        <source> (and {} more)</source>
        <translation> (und {} weitere)</translation>
    </message>
    <message>
        <source>Stopping</source>
        <translation>Wird angehalten</translation>
    </message>
    <message>
        <source>{} s</source>
        <translation>{} s</translation>
    </message>
</context>
<context>
    <name>ReadOnlyView</name>
    <message>
        <source>Read-only</source>
        <translation>Schreibgeschützt</translation>
    </message>
    <message>
        <source>Read-only: this session is damaged. To continue working, close it, open it again and salvage a copy.</source>
        <translation>Schreibgeschützt: Diese Sitzung ist beschädigt. Um weiterzuarbeiten, schließen Sie sie, öffnen Sie sie erneut und retten Sie eine Kopie.</translation>
    </message>
    <message>
        <source>Read-only: another program is using this session. It is shown as it was when opened.</source>
        <translation>Schreibgeschützt: Ein anderes Programm benutzt diese Sitzung. Sie wird so gezeigt, wie sie beim Öffnen war.</translation>
    </message>
    <message>
        <source>Read-only: the session folder is not writable. To continue working, make it writable or copy it.</source>
        <translation>Schreibgeschützt: Der Ordner dieser Sitzung ist nicht beschreibbar. Um weiterzuarbeiten, machen Sie ihn beschreibbar oder kopieren Sie ihn.</translation>
    </message>
</context>
<context>
    <name>ReadingBox</name>
    <message>
        <source>Reading recordings</source>
        <translation>Aufzeichnungen lesen</translation>
    </message>
    <message>
        <source>Sensor mount, degrees</source>
        <translation>Montage des Sensors, Grad</translation>
    </message>
    <message>
        <source>Off: mounting from the session, or no rotation. On: rotation about the flange&apos;s fixed axes x, y, z.</source>
        <translation>Aus: Montage aus der Sitzung, sonst keine Drehung. Ein: Drehung um die festen Achsen x, y, z des Flansches.</translation>
    </message>
    <message>
        <source>Mount about {axis}, degrees</source>
        <translation>Montage um {axis}, Grad</translation>
    </message>
    <message>
        <source>Delay of the wrench relative to its pose, ms</source>
        <translation>Verzögerung des Messwerts gegenüber seiner Pose, ms</translation>
    </message>
    <message>
        <source>Delay</source>
        <translation>Verzug</translation>
    </message>
</context>
<context>
    <name>RegionAutosave</name>
    <message>
        <source>Saving regions</source>
        <translation>Die Regionen werden behalten</translation>
    </message>
</context>
<context>
    <name>RegionBrush</name>
    <message>
        <source>No region selected. Add one or select one in the list, then paint.</source>
        <translation>Keine Region gewählt. Fügen Sie eine hinzu oder wählen Sie eine in der Liste, dann malen Sie.</translation>
    </message>
</context>
<context>
    <name>RegionListWidget</name>
    <message>
        <source>Regions, highest priority first</source>
        <translation>Regionen, die wichtigste zuerst</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Add a region with the lowest priority</source>
        <translation>Eine Region mit der niedrigsten Priorität hinzufügen</translation>
    </message>
    <message>
        <source>Colour</source>
        <translation>Farbe</translation>
    </message>
    <message>
        <source>Choose colour</source>
        <translation>Farbe wählen</translation>
    </message>
    <message>
        <source>Raise the priority (Alt+Up)</source>
        <translation>Priorität erhöhen (Alt+Hoch)</translation>
    </message>
    <message>
        <source>Lower the priority (Alt+Down)</source>
        <translation>Priorität senken (Alt+Herunter)</translation>
    </message>
    <message>
        <source>Remove the region; its facets become unassigned</source>
        <translation>Die Region entfernen; ihre Facetten gehören dann zu keiner</translation>
    </message>
    <message>
        <source>Raise region priority</source>
        <translation>Priorität der Region erhöhen</translation>
    </message>
    <message>
        <source>Lower region priority</source>
        <translation>Priorität der Region senken</translation>
    </message>
    <message>
        <source>Untouchable</source>
        <translation>Nicht berührbar</translation>
    </message>
    <message>
        <source>These facets cannot be touched, for example under a clamp or drape. Contacts there are treated as 1000 times less likely.</source>
        <translation>Diese Facetten sind nicht berührbar, etwa unter einer Klemme oder einem Tuch. Kontakte dort gelten als 1000-mal weniger wahrscheinlich.</translation>
    </message>
</context>
<context>
    <name>RegionRows</name>
    <message>
        <source>Priority</source>
        <translation>Priorität</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>cm²</source>
        <translation>cm²</translation>
    </message>
    <message>
        <source>Facets</source>
        <translation>Facetten</translation>
    </message>
    <message>
        <source>✕ {0} (untouchable)</source>
        <translation>✕ {0} (nicht berührbar)</translation>
    </message>
    <message>
        <source>{0}, untouchable, priority {1}, {2:.2f} cm²</source>
        <translation>{0}, nicht berührbar, Priorität {1}, {2:.2f} cm²</translation>
    </message>
    <message>
        <source>{0}, priority {1}, {2:.2f} cm²</source>
        <translation>{0}, Priorität {1}, {2:.2f} cm²</translation>
    </message>
    <message>
        <source>Priority {0}, colour {1}. Click to choose another colour.</source>
        <translation>Priorität {0}, Farbe {1}. Klicken Sie, um eine andere Farbe zu wählen.</translation>
    </message>
    <message>
        <source>Double-click to rename. Drag or press Alt+Up or Alt+Down to change the priority.</source>
        <translation>Doppelklick zum Umbenennen. Ziehen oder Alt+Hoch und Alt+Herunter ändert die Priorität.</translation>
    </message>
    <message>
        <source>Area: {0:.1f} mm²; facets: {1:,}.</source>
        <translation>Fläche: {0:.1f} mm²; Facetten: {1:,}.</translation>
    </message>
</context>
<context>
    <name>RegionsPage</name>
    <message>
        <source>Smaller brush</source>
        <translation>Kleinerer Pinsel</translation>
    </message>
    <message>
        <source>Larger brush</source>
        <translation>Größerer Pinsel</translation>
    </message>
    <message>
        <source>Cancel the stroke, or navigate</source>
        <translation>Strich abbrechen, oder navigieren</translation>
    </message>
    <message>
        <source>No probe yet. Prepare it first, then paint regions on it.</source>
        <translation>Noch keine Sonde. Bereiten Sie sie zuerst vor, dann malen Sie Regionen darauf.</translation>
    </message>
    <message>
        <source>Cancelled.</source>
        <translation>Abgebrochen.</translation>
    </message>
    <message>
        <source>Preparing the surface for painting</source>
        <translation>Die Fläche zum Bemalen wird vorbereitet</translation>
    </message>
    <message>
        <source>What was painted cannot be undone any more: the probe&apos;s surface has changed.</source>
        <translation>Das Gemalte lässt sich nicht mehr rückgängig machen: Die Oberfläche der Sonde hat sich geändert.</translation>
    </message>
    <message>
        <source>Facets: {0:,}; area: {1:.2f} cm²</source>
        <translation>Facetten: {0:,}; Fläche: {1:.2f} cm²</translation>
    </message>
    <message>
        <source>Finding facets</source>
        <translation>Die Facetten werden gesucht</translation>
    </message>
    <message>
        <source>No change: the region already has this shape.</source>
        <translation>Keine Änderung: Die Region hat schon diese Form.</translation>
    </message>
    <message>
        <source>apply regions to probe</source>
        <translation>Regionen auf die Sonde anwenden</translation>
    </message>
    <message>
        <source>Regions applied to the probe.</source>
        <translation>Die Regionen sind auf die Sonde angewendet.</translation>
    </message>
    <message>
        <source>Applying regions</source>
        <translation>Regionen werden angewendet</translation>
    </message>
    <message>
        <source>Import regions</source>
        <translation>Regionen importieren</translation>
    </message>
    <message>
        <source>Regions (*.json *.csv)</source>
        <translation>Regionen (*.json *.csv)</translation>
    </message>
    <message>
        <source>Export regions</source>
        <translation>Regionen exportieren</translation>
    </message>
    <message>
        <source>Reading regions</source>
        <translation>Regionen werden gelesen</translation>
    </message>
    <message>
        <source>Regions saved to {0}.</source>
        <translation>Regionen in {0} gespeichert.</translation>
    </message>
    <message>
        <source>Writing regions</source>
        <translation>Regionen werden geschrieben</translation>
    </message>
</context>
<context>
    <name>RegionsPanel</name>
    <message>
        <source>Regions</source>
        <translation>Regionen</translation>
    </message>
    <message>
        <source>Mark the areas meant to be touched, most important first. If a reading fits several places, these areas are preferred. Regions are optional.</source>
        <translation>Markieren Sie die Flächen, die berührt werden sollen, die wichtigsten zuerst. Passt ein Messwert zu mehreren Stellen, werden diese Flächen bevorzugt. Regionen sind optional.</translation>
    </message>
    <message>
        <source>Open Probe</source>
        <translation>Sonde öffnen</translation>
    </message>
    <message>
        <source>Apply regions</source>
        <translation>Regionen anwenden</translation>
    </message>
    <message>
        <source>Recompute the probe with more facets in the regions</source>
        <translation>Die Sonde mit mehr Facetten in den Regionen neu berechnen</translation>
    </message>
    <message>
        <source>Import…</source>
        <translation>Importieren…</translation>
    </message>
    <message>
        <source>Replace all regions with those in a JSON or CSV file</source>
        <translation>Alle Regionen durch die einer JSON- oder CSV-Datei ersetzen</translation>
    </message>
    <message>
        <source>Export…</source>
        <translation>Exportieren…</translation>
    </message>
    <message>
        <source>Save the regions to a JSON or CSV file</source>
        <translation>Die Regionen in einer JSON- oder CSV-Datei speichern</translation>
    </message>
    <message>
        <source>Next: Verify</source>
        <translation>Weiter: Prüfen</translation>
    </message>
    <message>
        <source>Next: Verify, without regions</source>
        <translation>Weiter: Prüfen, ohne Regionen</translation>
    </message>
    <message>
        <source>Preparing the surface for painting…</source>
        <translation>Die Fläche zum Bemalen wird vorbereitet…</translation>
    </message>
    <message>
        <source>Computing…</source>
        <translation>Wird berechnet.</translation>
    </message>
    <message>
        <source>The regions were not saved: {0} The next change tries again.</source>
        <translation>Die Regionen wurden nicht gespeichert: {0} Die nächste Änderung versucht es wieder.</translation>
    </message>
    <message>
        <source>No regions yet. Add one, then paint it on the probe.</source>
        <translation>Noch keine Regionen. Fügen Sie eine hinzu und malen Sie sie auf die Sonde.</translation>
    </message>
    <message>
        <source>Select a region in the list, then paint it on the probe.</source>
        <translation>Wählen Sie eine Region in der Liste und malen Sie sie auf die Sonde.</translation>
    </message>
    <message>
        <source>Nothing painted yet. Choose the brush and drag over the probe.</source>
        <translation>Noch nichts gemalt. Wählen Sie den Pinsel und ziehen Sie über die Sonde.</translation>
    </message>
    <message>
        <source>Saving…</source>
        <translation>Wird gespeichert…</translation>
    </message>
    <message>
        <source>The probe has these regions.</source>
        <translation>Die Sonde hat diese Regionen.</translation>
    </message>
    <message>
        <source>Saved. The regions are applied when the probe is prepared.</source>
        <translation>Gespeichert. Die Regionen werden beim Vorbereiten der Sonde angewendet.</translation>
    </message>
    <message>
        <source>Saved, but not yet applied to the probe.</source>
        <translation>Gespeichert, aber noch nicht auf die Sonde angewendet.</translation>
    </message>
</context>
<context>
    <name>ResidualTable</name>
    <message>
        <source>Poses</source>
        <translation>Posen</translation>
    </message>
    <message>
        <source>Leave out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>Restore</source>
        <translation>Wieder einbeziehen</translation>
    </message>
</context>
<context>
    <name>ResultPanel</name>
    <message>
        <source>Open report</source>
        <translation>Bericht öffnen</translation>
    </message>
    <message>
        <source>Not verified yet</source>
        <translation>Noch nicht überprüft</translation>
    </message>
    <message>
        <source>Does not count</source>
        <translation>Zählt nicht</translation>
    </message>
    <message>
        <source>Outdated: verify again</source>
        <translation>Veraltet: erneut überprüfen</translation>
    </message>
    <message>
        <source>Passed</source>
        <translation>Bestanden</translation>
    </message>
    <message>
        <source>Not passed</source>
        <translation>Nicht bestanden</translation>
    </message>
    <message>
        <source>no accepted touches</source>
        <translation>keine Berührung zählte</translation>
    </message>
    <message>
        <source>{mean} mm</source>
        <translation>{mean} mm</translation>
    </message>
    <message>
        <source>error of a single touch</source>
        <translation>Fehler einer einzigen Berührung</translation>
    </message>
    <message>
        <source>mean error of {count} touches</source>
        <translation>mittlerer Fehler von {count} Berührungen</translation>
    </message>
    <message>
        <source>mean error of {count} touches; 95 % CI {low}–{high} mm</source>
        <translation>mittlerer Fehler von {count} Berührungen; 95-%-Konfidenzintervall {low}–{high} mm</translation>
    </message>
    <message>
        <source>Largest error: {size} mm (limit {limit} mm)</source>
        <translation>Größter Fehler: {size} mm (Grenze {limit} mm)</translation>
    </message>
    <message>
        <source>Limit of the mean error: {limit} mm</source>
        <translation>Grenze des mittleren Fehlers: {limit} mm</translation>
    </message>
    <message>
        <source>95 % of touches within {size} mm</source>
        <translation>95 % der Berührungen innerhalb von {size} mm</translation>
    </message>
    <message>
        <source>Show the worst marker</source>
        <translation>Schlechteste Marke zeigen</translation>
    </message>
    <message>
        <source>Turn the 3D view to the marker with the largest error</source>
        <translation>Die 3D-Ansicht zur Marke mit dem größten Fehler drehen</translation>
    </message>
    <message>
        <source>{ratio} times the expected error (noise and calibration)</source>
        <translation>das {ratio}-Fache des erwarteten Fehlers (Rauschen und Kalibrierung)</translation>
    </message>
    <message>
        <source>Not counted: {listed}.</source>
        <translation>Nicht gezählt: {listed}.</translation>
    </message>
</context>
<context>
    <name>ScaleBar</name>
    <message>
        <source>Scale bar: {length}</source>
        <translation>Maßstab: {length}</translation>
    </message>
    <message>
        <source>{length:g} mm</source>
        <translation>{length:g} mm</translation>
    </message>
</context>
<context>
    <name>Scene</name>
    <message>
        <source>3D view of the probe</source>
        <translation>3D-Ansicht der Sonde</translation>
    </message>
    <message>
        <source>down</source>
        <translation>unten</translation>
    </message>
    <message>
        <source>error, mm</source>
        <translation>Fehler, mm</translation>
    </message>
    <message>
        <source>made up: hatched</source>
        <translation>ergänzt: schraffiert</translation>
    </message>
    <message>
        <source>made up: a narrow seam</source>
        <translation>ergänzt: schmale Naht</translation>
    </message>
    <message>
        <source>untouchable: crossed</source>
        <translation>unberührbar: gekreuzt</translation>
    </message>
    <message>
        <source>error, {times} times</source>
        <translation>Fehler, {times}-fach</translation>
    </message>
    <message>
        <source>95 % of noise, {times} times</source>
        <translation>95 % des Rauschens, {times}-fach</translation>
    </message>
    <message>
        <source>possible alternative</source>
        <translation>mögliche Alternative</translation>
    </message>
</context>
<context>
    <name>SensorSource</name>
    <message>
        <source>Force/torque sensor</source>
        <translation>Kraft-Momenten-Sensor</translation>
    </message>
    <message>
        <source>Sensor made by {maker}</source>
        <translation>Sensor von {maker}</translation>
    </message>
    <message>
        <source>with the {name} probe</source>
        <translation>mit der Sonde {name}</translation>
    </message>
    <message>
        <source>Recording</source>
        <translation>Aufzeichnung</translation>
    </message>
    <message>
        <source>Recordings (*.mcap);;All files (*)</source>
        <translation>Aufzeichnungen (*.mcap);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Sensor manufacturer</source>
        <translation>Hersteller des Sensors</translation>
    </message>
    <message>
        <source>Virtual bench probe</source>
        <translation>Sonde des virtuellen Messplatzes</translation>
    </message>
    <message>
        <source>Sensor address</source>
        <translation>Adresse des Sensors</translation>
    </message>
    <message>
        <source>One of contactbench record devices, such as sri+tcp or line+udp, then :// and the device address</source>
        <translation>Eine aus contactbench record devices, etwa sri+tcp oder line+udp, dann :// und die Geräteadresse</translation>
    </message>
    <message>
        <source> (not plugged in)</source>
        <translation> (nicht eingesteckt)</translation>
    </message>
    <message>
        <source>Virtual bench</source>
        <translation>Virtueller Messplatz</translation>
    </message>
    <message>
        <source>Replay a recording</source>
        <translation>Aufzeichnung wiedergeben</translation>
    </message>
    <message>
        <source>Enter address</source>
        <translation>Adresse eingeben</translation>
    </message>
    <message>
        <source>{guess} sensor at {path}</source>
        <translation>{guess}-Sensor an {path}</translation>
    </message>
</context>
<context>
    <name>SessionProbe</name>
    <message>
        <source>Loading probe</source>
        <translation>Die Sonde wird geladen</translation>
    </message>
</context>
<context>
    <name>Sessions</name>
    <message>
        <source>Finding recent sessions</source>
        <translation>Zuletzt benutzte Sitzungen werden gesucht</translation>
    </message>
    <message>
        <source>Preparing virtual bench</source>
        <translation>Der virtuelle Messplatz wird vorbereitet</translation>
    </message>
    <message>
        <source>Opening {}</source>
        <translation>{} wird geöffnet</translation>
    </message>
    <message>
        <source>Opening {} up to the damage</source>
        <translation>{} wird bis zum Schaden geöffnet</translation>
    </message>
    <message>
        <source>Creating {}</source>
        <translation>{} wird angelegt</translation>
    </message>
    <message>
        <source>Create a session in a new or empty folder</source>
        <translation>Sitzung in einem neuen oder leeren Ordner anlegen</translation>
    </message>
    <message>
        <source>Create session</source>
        <translation>Sitzung anlegen</translation>
    </message>
    <message>
        <source>Open session folder</source>
        <translation>Sitzungsordner öffnen</translation>
    </message>
    <message>
        <source>The last run on {} ended unexpectedly during a recording. Everything up to half a second before that is intact. Add the recording to the session?</source>
        <translation>Die letzte Arbeit an {} endete unerwartet während einer Aufzeichnung. Alles bis eine halbe Sekunde davor ist erhalten. Die Aufzeichnung in die Sitzung übernehmen?</translation>
    </message>
    <message>
        <source>The last run on {} ended unexpectedly during {} recordings. Everything up to half a second before that is intact. Add the recordings to the session?</source>
        <translation>Die letzte Arbeit an {} endete unerwartet während {} Aufzeichnungen. Alles bis eine halbe Sekunde davor ist erhalten. Die Aufzeichnungen in die Sitzung übernehmen?</translation>
    </message>
    <message>
        <source>Add recordings</source>
        <translation>Aufzeichnungen übernehmen</translation>
    </message>
    <message>
        <source>Add recording</source>
        <translation>Aufzeichnung übernehmen</translation>
    </message>
    <message>
        <source>Leave them for later</source>
        <translation>Für später lassen</translation>
    </message>
    <message>
        <source>Leave it for later</source>
        <translation>Für später lassen</translation>
    </message>
    <message>
        <source>Choose another session</source>
        <translation>Andere Sitzung wählen</translation>
    </message>
    <message>
        <source>Adding recordings</source>
        <translation>Die Aufzeichnungen werden übernommen</translation>
    </message>
    <message>
        <source>Could not open the session: {}</source>
        <translation>Die Sitzung konnte nicht geöffnet werden: {}</translation>
    </message>
    <message>
        <source>Nothing is lost, and nothing can be added. All {} whole records are shown.</source>
        <translation>Nichts geht verloren, und nichts kann hinzukommen. Alle {} heilen Einträge sind zu sehen.</translation>
    </message>
    <message>
        <source>Open up to the damage</source>
        <translation>Bis zum Schaden öffnen</translation>
    </message>
    <message>
        <source>All {} whole records go into a new session; this one stays as it is. What is lost: at least {}.</source>
        <translation>Alle {} heilen Einträge kommen in eine neue Sitzung; diese bleibt, wie sie ist. Verloren geht mindestens: {}.</translation>
    </message>
    <message>
        <source>To be done again: {}.</source>
        <translation>Neu zu machen: {}.</translation>
    </message>
    <message>
        <source>Files: {}</source>
        <translation>Dateien: {}</translation>
    </message>
    <message>
        <source>The first {} records go on as this session; {} after them are set aside, and the journal as it was is kept beside.</source>
        <translation>Die ersten {} Einträge gehen als diese Sitzung weiter; {} danach werden beiseitegelegt, und das bisherige Journal bleibt daneben erhalten.</translation>
    </message>
    <message>
        <source>What is lost: {}.</source>
        <translation>Verloren geht: {}.</translation>
    </message>
    <message>
        <source>1 record</source>
        <translation>1 Eintrag</translation>
    </message>
    <message>
        <source>{} records</source>
        <translation>{} Einträge</translation>
    </message>
    <message>
        <source>Salvaging a copy of {}</source>
        <translation>Eine Kopie von {} wird gerettet</translation>
    </message>
    <message>
        <source>Looking at the damage of {}</source>
        <translation>Der Schaden von {} wird untersucht</translation>
    </message>
    <message>
        <source>Salvage a copy</source>
        <translation>Kopie retten</translation>
    </message>
    <message>
        <source>Open read-only</source>
        <translation>Schreibgeschützt öffnen</translation>
    </message>
    <message>
        <source>Try again</source>
        <translation>Erneut versuchen</translation>
    </message>
</context>
<context>
    <name>ShapePanel</name>
    <message>
        <source>Selected region</source>
        <translation>Die gewählte Region</translation>
    </message>
    <message>
        <source>Mirror the selected region</source>
        <translation>Gewählte Region spiegeln</translation>
    </message>
    <message>
        <source>Mirror</source>
        <translation>Spiegeln</translation>
    </message>
    <message>
        <source>Add the mirror image across the plane (M)</source>
        <translation>Das Spiegelbild an der Ebene hinzufügen (M)</translation>
    </message>
    <message>
        <source>Mirror plane</source>
        <translation>Spiegelebene</translation>
    </message>
    <message>
        <source>at {0} =</source>
        <translation>bei {0} =</translation>
    </message>
    <message>
        <source>Position of the mirror plane, mm in the sensor frame S</source>
        <translation>Lage der Spiegelebene, mm im Sensorsystem S</translation>
    </message>
    <message>
        <source>Distance to grow or shrink along the surface, mm</source>
        <translation>Strecke zum Vergrößern oder Verkleinern entlang der Oberfläche, mm</translation>
    </message>
    <message>
        <source>Rings: </source>
        <translation>Ringe: </translation>
    </message>
    <message>
        <source>Smoothing width in rings of facets</source>
        <translation>Breite der Glättung in Facettenringen</translation>
    </message>
    <message>
        <source>Removes details narrower than about this many facets</source>
        <translation>Entfernt Einzelheiten, die schmaler als etwa so viele Facetten sind</translation>
    </message>
    <message>
        <source>Grow</source>
        <translation>Vergrößern</translation>
    </message>
    <message>
        <source>Move the border outwards; other regions are unchanged</source>
        <translation>Den Rand nach außen schieben; andere Regionen bleiben unverändert</translation>
    </message>
    <message>
        <source>Shrink</source>
        <translation>Verkleinern</translation>
    </message>
    <message>
        <source>Move the border inwards</source>
        <translation>Den Rand nach innen schieben</translation>
    </message>
    <message>
        <source>Smooth</source>
        <translation>Glätten</translation>
    </message>
    <message>
        <source>Straighten the border, fill holes, remove specks</source>
        <translation>Rand begradigen, Löcher füllen, Flecken entfernen</translation>
    </message>
    <message>
        <source>Clear</source>
        <translation>Leeren</translation>
    </message>
    <message>
        <source>Remove all facets from the region</source>
        <translation>Alle Facetten aus der Region entfernen</translation>
    </message>
</context>
<context>
    <name>ShowDialog</name>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
</context>
<context>
    <name>Shrinking</name>
    <message>
        <source>Contact error over poses</source>
        <translation>Kontaktfehler über den Posen</translation>
    </message>
</context>
<context>
    <name>Side</name>
    <message>
        <source>Displayed quantity</source>
        <translation>Gezeigte Größe</translation>
    </message>
    <message>
        <source>Value at the pointer</source>
        <translation>Wert am Zeiger</translation>
    </message>
    <message>
        <source>± 1 sigma. Density: from the number of touches.
Means: spread of the averaged values. Peak force: sensor noise.</source>
        <translation>± 1 Sigma. Dichte: aus der Zahl der Berührungen.
Mittelwerte: Streuung der gemittelten Werte. Größte Kraft: Rauschen des Sensors.</translation>
    </message>
    <message>
        <source>Nothing to show: {why}</source>
        <translation>Nichts zu zeigen: {why}</translation>
    </message>
    <message>
        <source>No contacts in this time window and force range. Widen one of them.</source>
        <translation>Keine Kontakte in diesem Zeitfenster und Kraftbereich. Erweitern Sie eines davon.</translation>
    </message>
    <message>
        <source>Touches: {count:,} of {all:,}; grey: no data</source>
        <translation>Berührungen: {count:,} von {all:,}; grau: keine Daten</translation>
    </message>
    <message>
        <source>Samples: {count:,} of {all:,}; grey: no data</source>
        <translation>Messwerte: {count:,} von {all:,}; grau: keine Daten</translation>
    </message>
    <message>
        <source>contact density</source>
        <translation>Kontaktdichte</translation>
    </message>
    <message>
        <source>mean force</source>
        <translation>mittlere Kraft</translation>
    </message>
    <message>
        <source>peak force</source>
        <translation>größte Kraft</translation>
    </message>
    <message>
        <source>mean error</source>
        <translation>mittlerer Fehler</translation>
    </message>
    <message>
        <source>uncertainty</source>
        <translation>Unsicherheit</translation>
    </message>
    <message>
        <source>point at the probe to read a value</source>
        <translation>zeigen Sie auf die Sonde, um einen Wert abzulesen</translation>
    </message>
    <message>
        <source>no data</source>
        <translation>keine Daten</translation>
    </message>
    <message>
        <source>at {x:.1f}, {y:.1f}, {z:.1f} mm</source>
        <translation>bei {x:.1f}, {y:.1f}, {z:.1f} mm</translation>
    </message>
</context>
<context>
    <name>StartPage</name>
    <message>
        <source>contactbench</source>
        <translation>contactbench</translation>
    </message>
    <message>
        <source>Calibrate a force/torque sensor behind a probe, prepare the probe mesh, verify contacts on the bench, and export a bundle.</source>
        <translation>Kalibrieren Sie einen Kraft-Momenten-Sensor hinter einer Sonde, bereiten Sie das Netz der Sonde vor, prüfen Sie Kontakte am Messplatz, und exportieren Sie ein Paket.</translation>
    </message>
    <message>
        <source>Recent sessions</source>
        <translation>Zuletzt benutzte Sitzungen</translation>
    </message>
    <message>
        <source>You can also drop a session folder on this window.</source>
        <translation>Sie können einen Sitzungsordner auch auf dieses Fenster ziehen.</translation>
    </message>
    <message>
        <source>Try the virtual bench</source>
        <translation>Virtuellen Messplatz ausprobieren</translation>
    </message>
    <message>
        <source>Simulated sensor, robot and probe; no hardware needed</source>
        <translation>Simulierter Sensor, Roboter und Sonde; keine Hardware nötig</translation>
    </message>
    <message>
        <source>New session</source>
        <translation>Neue Sitzung</translation>
    </message>
    <message>
        <source>Start with an empty folder for one sensor and one probe</source>
        <translation>Mit einem leeren Ordner für einen Sensor und eine Sonde beginnen</translation>
    </message>
    <message>
        <source>Open session</source>
        <translation>Sitzung öffnen</translation>
    </message>
    <message>
        <source>Open an existing session</source>
        <translation>Eine vorhandene Sitzung öffnen</translation>
    </message>
    <message>
        <source>missing: moved or deleted</source>
        <translation>fehlt: verschoben oder gelöscht</translation>
    </message>
    <message>
        <source>session</source>
        <translation>Sitzung</translation>
    </message>
</context>
<context>
    <name>StepList</name>
    <message>
        <source>Steps</source>
        <translation>Schritte</translation>
    </message>
    <message>
        <source>Devices</source>
        <translation>Geräte</translation>
    </message>
    <message>
        <source>Gravity</source>
        <translation>Schwerkraft</translation>
    </message>
    <message>
        <source>Probe</source>
        <translation>Sonde</translation>
    </message>
    <message>
        <source>Regions</source>
        <translation>Regionen</translation>
    </message>
    <message>
        <source>Verify</source>
        <translation>Prüfen</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>Export</translation>
    </message>
    <message>
        <source>locked</source>
        <translation>gesperrt</translation>
    </message>
    <message>
        <source>ready</source>
        <translation>bereit</translation>
    </message>
    <message>
        <source>running</source>
        <translation>läuft</translation>
    </message>
    <message>
        <source>done</source>
        <translation>erledigt</translation>
    </message>
    <message>
        <source>failed</source>
        <translation>gescheitert</translation>
    </message>
    <message>
        <source>stale</source>
        <translation>veraltet</translation>
    </message>
</context>
<context>
    <name>StripChart</name>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>Force magnitude</source>
        <translation>Betrag der Kraft</translation>
    </message>
    <message>
        <source>Contact point</source>
        <translation>Kontaktpunkt</translation>
    </message>
    <message>
        <source>No measurements yet. Choose devices first.</source>
        <translation>Noch keine Messwerte. Wählen Sie zuerst Geräte.</translation>
    </message>
    <message>
        <source>Raw</source>
        <translation>Roh</translation>
    </message>
    <message>
        <source>Compensated</source>
        <translation>Kompensiert</translation>
    </message>
    <message>
        <source>Raw or compensated wrenches in the charts</source>
        <translation>Rohe oder kompensierte Messwerte in den Diagrammen</translation>
    </message>
    <message>
        <source>Raw: sensor readings. Compensated: bias and weight removed.</source>
        <translation>Roh: Messwerte des Sensors. Kompensiert: ohne Nullpunktfehler und Gewicht.</translation>
    </message>
    <message>
        <source>{seconds:g} s</source>
        <translation>{seconds:g} s</translation>
    </message>
    <message>
        <source>Time range of the charts</source>
        <translation>Zeitbereich der Diagramme</translation>
    </message>
    <message>
        <source>Time range in seconds</source>
        <translation>Zeitbereich in Sekunden</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>Freeze the charts; recording continues</source>
        <translation>Die Diagramme einfrieren; die Aufzeichnung geht weiter</translation>
    </message>
    <message>
        <source>Resume live view</source>
        <translation>Zurück zur Live-Ansicht</translation>
    </message>
    <message>
        <source>Show current measurements</source>
        <translation>Aktuelle Messwerte zeigen</translation>
    </message>
    <message>
        <source>Charts shown</source>
        <translation>Diagramme</translation>
    </message>
    <message>
        <source>Choose which charts to show</source>
        <translation>Wählen, welche Diagramme gezeigt werden</translation>
    </message>
</context>
<context>
    <name>SurfaceSection</name>
    <message>
        <source>2  Outer surface</source>
        <translation>2  Außenfläche</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>Automatisch</translation>
    </message>
    <message>
        <source>Smooth surface</source>
        <translation>Glatte Fläche</translation>
    </message>
    <message>
        <source>Straight lines</source>
        <translation>Gerade Linien</translation>
    </message>
    <message>
        <source>Hull of the rim</source>
        <translation>Hülle des Rands</translation>
    </message>
    <message>
        <source>Leave open</source>
        <translation>Offen lassen</translation>
    </message>
    <message>
        <source>Method for closing openings such as the cable outlet</source>
        <translation>Methode zum Schließen von Öffnungen, etwa für das Kabel</translation>
    </message>
    <message>
        <source>Close openings</source>
        <translation>Öffnungen schließen</translation>
    </message>
</context>
<context>
    <name>TimeBar</name>
    <message>
        <source>Time window</source>
        <translation>Zeitfenster</translation>
    </message>
    <message>
        <source>Time in seconds. Drag the handles or the bar between them; above the line: current time.
Keys: left and right; Space switches handles.</source>
        <translation>Zeit in Sekunden. Ziehen Sie die Griffe oder den Balken dazwischen; über der Linie: aktueller Zeitpunkt.
Tasten: links und rechts; Leertaste wechselt den Griff.</translation>
    </message>
    <message>
        <source>Show all</source>
        <translation>Alles zeigen</translation>
    </message>
    <message>
        <source>Stop and show the whole time window.</source>
        <translation>Anhalten und das ganze Zeitfenster zeigen.</translation>
    </message>
    <message>
        <source>{speed:g}x</source>
        <translation>{speed:g}x</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Tempo</translation>
    </message>
    <message>
        <source>Recorded seconds per second of playback.</source>
        <translation>Aufgezeichnete Sekunden pro Sekunde Wiedergabe.</translation>
    </message>
    <message>
        <source>keep touches</source>
        <translation>Berührungen behalten</translation>
    </message>
    <message>
        <source>last {seconds:g} s</source>
        <translation>letzte {seconds:g} s</translation>
    </message>
    <message>
        <source>Contacts shown during playback</source>
        <translation>Kontakte beim Abspielen</translation>
    </message>
    <message>
        <source>During playback: show all contacts from the start, or only the last seconds.</source>
        <translation>Beim Abspielen: alle Kontakte seit dem Beginn zeigen, oder nur die letzten Sekunden.</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>Play</source>
        <translation>Abspielen</translation>
    </message>
    <message>
        <source>{start:.1f} to {end:.1f} s of {whole:.1f} s</source>
        <translation>{start:.1f} bis {end:.1f} s von {whole:.1f} s</translation>
    </message>
</context>
<context>
    <name>ToolPanel</name>
    <message>
        <source>Protect other regions</source>
        <translation>Andere Regionen schützen</translation>
    </message>
    <message>
        <source>Facets of other regions are not changed</source>
        <translation>Facetten anderer Regionen werden nicht geändert</translation>
    </message>
    <message>
        <source>Now click the opposite corner.</source>
        <translation>Klicken Sie jetzt die gegenüberliegende Ecke an.</translation>
    </message>
    <message>
        <source>Each lower limit must be below the upper limit.</source>
        <translation>Jede untere Grenze muss kleiner sein als die obere.</translation>
    </message>
    <message>
        <source>Navigate</source>
        <translation>Navigieren</translation>
    </message>
    <message>
        <source>Rotate the view with the left button</source>
        <translation>Die Ansicht mit der linken Taste drehen</translation>
    </message>
    <message>
        <source>Brush</source>
        <translation>Pinsel</translation>
    </message>
    <message>
        <source>Paint the selected region</source>
        <translation>Die gewählte Region malen</translation>
    </message>
    <message>
        <source>Eraser</source>
        <translation>Radierer</translation>
    </message>
    <message>
        <source>Remove facets from their region</source>
        <translation>Facetten aus ihrer Region entfernen</translation>
    </message>
    <message>
        <source>Fill</source>
        <translation>Füllen</translation>
    </message>
    <message>
        <source>Fill up to sharp edges</source>
        <translation>Bis zu scharfen Kanten füllen</translation>
    </message>
    <message>
        <source>Box</source>
        <translation>Quader</translation>
    </message>
    <message>
        <source>Select everything between two corners</source>
        <translation>Alles zwischen zwei Ecken</translation>
    </message>
    <message>
        <source>Half</source>
        <translation>Hälfte</translation>
    </message>
    <message>
        <source>Select everything on one side of a plane</source>
        <translation>Alles auf einer Seite einer Ebene</translation>
    </message>
    <message>
        <source>{0} (regions)</source>
        <translation>{0} (Regionen)</translation>
    </message>
    <message>
        <source>Choose a tool. The right button always rotates the view.</source>
        <translation>Wählen Sie ein Werkzeug. Die rechte Taste dreht immer die Ansicht.</translation>
    </message>
    <message>
        <source>Radius</source>
        <translation>Radius</translation>
    </message>
    <message>
        <source>Brush radius</source>
        <translation>Radius des Pinsels</translation>
    </message>
    <message>
        <source>[ and ], or Ctrl + wheel</source>
        <translation>[ und ], oder Strg + Mausrad</translation>
    </message>
    <message>
        <source>Brush radius, mm</source>
        <translation>Radius des Pinsels, mm</translation>
    </message>
    <message>
        <source>Drag over the probe. Shift erases. Esc cancels the stroke.</source>
        <translation>Über die Sonde ziehen. Umschalt radiert. Esc bricht den Strich ab.</translation>
    </message>
    <message>
        <source>Edge limit</source>
        <translation>Kantengrenze</translation>
    </message>
    <message>
        <source>Sharpest edge to cross</source>
        <translation>Schärfste überschrittene Kante</translation>
    </message>
    <message>
        <source>Sharpest edge to cross, degrees</source>
        <translation>Schärfste überschrittene Kante, Grad</translation>
    </message>
    <message>
        <source>The fill stops at edges sharper than this, degrees</source>
        <translation>Das Füllen endet an schärferen Kanten, Grad</translation>
    </message>
    <message>
        <source>Remove instead</source>
        <translation>Stattdessen entfernen</translation>
    </message>
    <message>
        <source>Click the probe to fill up to the nearest sharp edges.</source>
        <translation>Auf die Sonde klicken, um bis zu den nächsten scharfen Kanten zu füllen.</translation>
    </message>
    <message>
        <source>low</source>
        <translation>unten</translation>
    </message>
    <message>
        <source>high</source>
        <translation>oben</translation>
    </message>
    <message>
        <source>{0} {1}, mm in the sensor frame S</source>
        <translation>{0} {1}, mm im Sensorsystem S</translation>
    </message>
    <message>
        <source>Click the probe to move the plane there, or enter a number.</source>
        <translation>Auf die Sonde klicken, um die Ebene dorthin zu legen, oder die Zahl eingeben.</translation>
    </message>
    <message>
        <source>Side of the plane</source>
        <translation>Welche Seite der Ebene</translation>
    </message>
    <message>
        <source>above {0}</source>
        <translation>über {0}</translation>
    </message>
    <message>
        <source>below {0}</source>
        <translation>unter {0}</translation>
    </message>
    <message>
        <source>Position of the plane, mm in the sensor frame S</source>
        <translation>Lage der Ebene, mm im Sensorsystem S</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Remove facets</source>
        <translation>Facetten entfernen</translation>
    </message>
    <message>
        <source>Remove these facets from the selected region</source>
        <translation>Diese Facetten aus der gewählten Region entfernen</translation>
    </message>
    <message>
        <source>Add these facets to the selected region</source>
        <translation>Diese Facetten zur gewählten Region hinzufügen</translation>
    </message>
    <message>
        <source>Click two opposite corners on the probe, or enter the numbers.</source>
        <translation>Zwei gegenüberliegende Ecken auf der Sonde anklicken, oder die Zahlen eingeben.</translation>
    </message>
</context>
<context>
    <name>TouchPanel</name>
    <message>
        <source>Touch again</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>Repeat the marker selected in the table, or the last one; all its touches count</source>
        <translation>Den in der Tabelle gewählten Marker wiederholen, sonst den letzten; alle seine Berührungen zählen</translation>
    </message>
    <message>
        <source>Skip marker</source>
        <translation>Marker auslassen</translation>
    </message>
    <message>
        <source>Skip the next marker and enter the reason, which appears in the report</source>
        <translation>Den nächsten Marker auslassen und den Grund eingeben; er erscheint im Bericht</translation>
    </message>
    <message>
        <source>Touch virtually</source>
        <translation>Virtuell berühren</translation>
    </message>
    <message>
        <source>The virtual bench presses the next marker with a tip</source>
        <translation>Der virtuelle Messplatz drückt mit einer Spitze auf den nächsten Marker</translation>
    </message>
    <message>
        <source>Touch all</source>
        <translation>Alle berühren</translation>
    </message>
    <message>
        <source>The virtual bench presses all markers in turn</source>
        <translation>Der virtuelle Messplatz drückt nacheinander auf alle Marker</translation>
    </message>
    <message>
        <source>Contact heatmap</source>
        <translation>Kontakt-Heatmap</translation>
    </message>
    <message>
        <source>Colour the probe by contact density, in contacts per mm²</source>
        <translation>Die Sonde nach Kontaktdichte färben, in Kontakten pro mm²</translation>
    </message>
    <message>
        <source>Mute tones</source>
        <translation>Töne stumm schalten</translation>
    </message>
    <message>
        <source>Each state has its own tone; press to mute</source>
        <translation>Jeder Zustand hat einen eigenen Ton; drücken zum Stummschalten</translation>
    </message>
    <message>
        <source>Tones muted</source>
        <translation>Töne stumm</translation>
    </message>
    <message>
        <source>Skip {name}</source>
        <translation>{name} auslassen</translation>
    </message>
    <message>
        <source>Reason for skipping {name} (appears in the report)</source>
        <translation>Grund für das Auslassen von {name} (erscheint im Bericht)</translation>
    </message>
    <message>
        <source>not reachable</source>
        <translation>nicht erreichbar</translation>
    </message>
    <message>
        <source>mark no longer visible</source>
        <translation>Markierung nicht mehr sichtbar</translation>
    </message>
    <message>
        <source>housing is too soft there</source>
        <translation>Gehäuse dort zu weich</translation>
    </message>
    <message>
        <source>a touch could cause damage</source>
        <translation>eine Berührung könnte Schaden anrichten</translation>
    </message>
    <message>
        <source>{name} was not skipped: enter a reason.</source>
        <translation>{name} wurde nicht ausgelassen: Geben Sie einen Grund an.</translation>
    </message>
    <message>
        <source>{name} was not skipped because it has been touched in the meantime.</source>
        <translation>{name} wurde nicht ausgelassen, weil der Marker inzwischen berührt wurde.</translation>
    </message>
    <message>
        <source>{name} skipped: {why}. The verdict and the report state the reason.</source>
        <translation>{name} ausgelassen: {why}. Ergebnis und Bericht nennen den Grund.</translation>
    </message>
    <message>
        <source>second touch</source>
        <translation>zweite Berührung</translation>
    </message>
    <message>
        <source>second touch, behind</source>
        <translation>zweite Berührung, dahinter</translation>
    </message>
    <message>
        <source>possible alternative</source>
        <translation>mögliche Alternative</translation>
    </message>
    <message>
        <source>possible alternative, behind</source>
        <translation>mögliche Alternative, dahinter</translation>
    </message>
    <message>
        <source>No sensor is open. Connect one in step 1, Devices.</source>
        <translation>Kein Sensor ist geöffnet. Verbinden Sie einen in Schritt 1, Geräte.</translation>
    </message>
    <message>
        <source>Place markers on the first tab.</source>
        <translation>Setzen Sie zuerst Marker auf dem ersten Reiter.</translation>
    </message>
    <message>
        <source>Remove everything from the probe, then start. After that, just touch the markers; no mouse is needed.</source>
        <translation>Nehmen Sie alles von der Sonde weg und starten Sie. Danach berühren Sie nur noch die Marker; eine Maus ist nicht nötig.</translation>
    </message>
    <message>
        <source>Press with {low} to {high} N and hold still.</source>
        <translation>Mit {low} bis {high} N drücken und still halten.</translation>
    </message>
    <message>
        <source>Adjust the force to {low}–{high} N and hold still.</source>
        <translation>Die Kraft auf {low}–{high} N bringen und still halten.</translation>
    </message>
    <message>
        <source>Keep still: measuring.</source>
        <translation>Still halten: Es wird gemessen.</translation>
    </message>
    <message>
        <source>Release.</source>
        <translation>Loslassen.</translation>
    </message>
    <message>
        <source>{why} ({force} N). Release, then touch again.</source>
        <translation>{why} ({force} N). Loslassen und noch einmal berühren.</translation>
    </message>
    <message>
        <source>{marker}: error {size} mm.</source>
        <translation>{marker}: Fehler {size} mm.</translation>
    </message>
    <message>
        <source>{marker}: error {size} mm. Release.</source>
        <translation>{marker}: Fehler {size} mm. Loslassen.</translation>
    </message>
    <message>
        <source>Confidence {percent} %</source>
        <translation>Sicherheit {percent} %</translation>
    </message>
    <message>
        <source>{sure} thanks to the defined regions; the wrench also fits another place.</source>
        <translation>{sure} dank der festgelegten Regionen; der Messwert passt auch zu einer anderen Stelle.</translation>
    </message>
    <message>
        <source>{sure}: the wrench also fits another place. Press in a different direction.</source>
        <translation>{sure}: Der Messwert passt auch zu einer anderen Stelle. Drücken Sie in eine andere Richtung.</translation>
    </message>
    <message>
        <source>Two touches detected; both are shown.</source>
        <translation>Zwei Berührungen erkannt; beide werden gezeigt.</translation>
    </message>
    <message>
        <source>No single touch explains this wrench (residual {sigmas} sigma, moment arm {arm} mm). Check for two simultaneous touches, and check units, mount and compensation.</source>
        <translation>Keine einzelne Berührung erklärt diesen Messwert (Abweichung {sigmas} Sigma, Hebelarm {arm} mm). Prüfen Sie, ob zwei Berührungen gleichzeitig auftreten, und prüfen Sie Einheiten, Montage und Kompensation.</translation>
    </message>
    <message>
        <source>The force is almost parallel to the surface. Press more directly into it.</source>
        <translation>Die Kraft ist fast parallel zur Oberfläche. Drücken Sie steiler.</translation>
    </message>
    <message>
        <source>The contact is outside all regions.</source>
        <translation>Der Kontakt liegt außerhalb aller Regionen.</translation>
    </message>
    <message>
        <source>The sensor is at the limit of its range. Press less hard.</source>
        <translation>Der Sensor ist an der Grenze seines Messbereichs. Drücken Sie weniger fest.</translation>
    </message>
    <message>
        <source>No part of the probe faces this force. Check the force sign and the mount.</source>
        <translation>Kein Teil der Sonde ist dieser Kraft zugewandt. Prüfen Sie das Vorzeichen der Kraft und die Montage.</translation>
    </message>
    <message>
        <source>On a facet added during repair: its position is an estimate.</source>
        <translation>Auf einer bei der Reparatur ergänzten Facette: Ihre Lage ist geschätzt.</translation>
    </message>
    <message>
        <source>On an untouchable region: check the region and the mount.</source>
        <translation>Auf einer nicht berührbaren Region: Prüfen Sie die Region und die Montage.</translation>
    </message>
    <message>
        <source>All markers touched ({done} touches). Finish, or repeat any marker.</source>
        <translation>Alle Marker berührt ({done} Berührungen). Beenden Sie, oder wiederholen Sie Marker.</translation>
    </message>
    <message>
        <source>Next: {name} · {done} of {wanted} touches</source>
        <translation>Als Nächstes: {name} · {done} von {wanted} Berührungen</translation>
    </message>
    <message>
        <source>of accepted touches</source>
        <translation>der gezählten Berührungen</translation>
    </message>
    <message>
        <source>largest {largest} mm; last: {ratio} times the expected noise</source>
        <translation>größter {largest} mm; letzter: das {ratio}-Fache des erwarteten Rauschens</translation>
    </message>
</context>
<context>
    <name>TouchState</name>
    <message>
        <source>not started</source>
        <translation>nicht begonnen</translation>
    </message>
    <message>
        <source>ready: touch</source>
        <translation>bereit: berühren</translation>
    </message>
    <message>
        <source>hold still</source>
        <translation>still halten</translation>
    </message>
    <message>
        <source>measuring</source>
        <translation>misst</translation>
    </message>
    <message>
        <source>accepted</source>
        <translation>gezählt</translation>
    </message>
    <message>
        <source>not counted</source>
        <translation>nicht gezählt</translation>
    </message>
    <message>
        <source>Touch state: {word}. {detail}</source>
        <translation>Zustand der Berührung: {word}. {detail}</translation>
    </message>
    <message>
        <source>{force} N</source>
        <translation>{force} N</translation>
    </message>
</context>
<context>
    <name>Toucher</name>
    <message>
        <source>{name} was pressed {count} times without an accepted touch ({why}). Press Skip marker, then Touch all again. Or discard the touches and move the marker.</source>
        <translation>{name} wurde {count}-mal gedrückt, ohne dass eine Berührung zählte ({why}). Drücken Sie „Marker auslassen“ und dann wieder „Alle berühren“. Oder verwerfen Sie die Berührungen und verschieben Sie den Marker.</translation>
    </message>
    <message>
        <source>no touch was detected</source>
        <translation>es wurde keine Berührung erkannt</translation>
    </message>
</context>
<context>
    <name>TradeoffChart</name>
    <message>
        <source>facets</source>
        <translation>Facetten</translation>
    </message>
    <message>
        <source>solve time, µs</source>
        <translation>Rechenzeit einer Lösung, µs</translation>
    </message>
    <message>
        <source>plain loop time, µs</source>
        <translation>Rechenzeit der einfachen Schleife, µs</translation>
    </message>
    <message>
        <source>Horizontal axis</source>
        <translation>Waagerechte Achse</translation>
    </message>
    <message>
        <source>Horizontal axis: facets, or µs per solve</source>
        <translation>Waagerechte Achse: Facetten, oder µs je Lösung</translation>
    </message>
    <message>
        <source>Error, mm, against</source>
        <translation>Fehler, mm, über</translation>
    </message>
    <message>
        <source>95th percentile of the contact shift relative to the full mesh, mm</source>
        <translation>95. Perzentil der Kontaktverschiebung gegenüber dem vollen Netz, mm</translation>
    </message>
    <message>
        <source>Contact error against facet count</source>
        <translation>Kontaktfehler über der Facettenzahl</translation>
    </message>
    <message>
        <source>limit {:.2g} mm</source>
        <translation>Grenze {:.2g} mm</translation>
    </message>
    <message>
        <source>knee</source>
        <translation>Knick</translation>
    </message>
    <message>
        <source>Choose a point with a click or the arrow keys.</source>
        <translation>Wählen Sie einen Punkt: mit einem Klick oder den Pfeiltasten.</translation>
    </message>
    <message>
        <source>{:,} facets: contacts shift by up to {:.2g} mm; one solve takes {:.2g} µs.</source>
        <translation>{:,} Facetten: Kontakte verschieben sich um bis zu {:.2g} mm; eine Lösung dauert {:.2g} µs.</translation>
    </message>
</context>
<context>
    <name>TroubleWatch</name>
    <message>
        <source>Checking session files</source>
        <translation>Sitzungsdateien werden geprüft</translation>
    </message>
    <message>
        <source>The disk is writable again and the session continues. Repeat the actions that were refused; earlier recordings are intact.</source>
        <translation>Der Datenträger ist wieder beschreibbar und die Sitzung geht weiter. Wiederholen Sie die abgelehnten Aktionen; frühere Aufzeichnungen sind unversehrt.</translation>
    </message>
    <message>
        <source>The sensor is back and sending readings.</source>
        <translation>Der Sensor ist wieder da und sendet Messwerte.</translation>
    </message>
    <message>
        <source>A file in this session has changed since it was written. Results that depend on it are invalid.</source>
        <translation>Eine Datei dieser Sitzung wurde nachträglich verändert. Ergebnisse, die darauf beruhen, sind ungültig.</translation>
    </message>
    <message>
        <source>{} files in this session have changed since they were written. Results that depend on them are invalid. Run `contactbench session verify` to list them.</source>
        <translation>{} Dateien dieser Sitzung wurden nachträglich verändert. Ergebnisse, die darauf beruhen, sind ungültig. `contactbench session verify` listet sie auf.</translation>
    </message>
    <message>
        <source>All files of this session are as they were written again.</source>
        <translation>Alle Dateien dieser Sitzung sind wieder so, wie sie geschrieben wurden.</translation>
    </message>
</context>
<context>
    <name>VerdictBox</name>
    <message>
        <source>Good</source>
        <translation>Gut</translation>
    </message>
    <message>
        <source>Usable</source>
        <translation>Brauchbar</translation>
    </message>
    <message>
        <source>Rejected: do not use</source>
        <translation>Abgelehnt: nicht benutzen</translation>
    </message>
    <message>
        <source>Not ready yet</source>
        <translation>Noch nicht bereit</translation>
    </message>
</context>
<context>
    <name>VerifyPage</name>
    <message>
        <source>Markers</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>Settings</source>
        <translation>Wie</translation>
    </message>
    <message>
        <source>Point</source>
        <translation>Punkt</translation>
    </message>
    <message>
        <source>Touch</source>
        <translation>Berühren</translation>
    </message>
    <message>
        <source>Result</source>
        <translation>Ergebnis</translation>
    </message>
    <message>
        <source>Drawing heatmap</source>
        <translation>Die Heatmap wird gezeichnet</translation>
    </message>
    <message>
        <source>All devices are sending samples again. Recording continues.</source>
        <translation>Alle Geräte senden wieder Messwerte. Die Aufzeichnung geht weiter.</translation>
    </message>
    <message>
        <source>Saving recording</source>
        <translation>Die Aufzeichnung wird gesichert</translation>
    </message>
    <message>
        <source>Loading verification</source>
        <translation>Die Überprüfung wird geladen</translation>
    </message>
    <message>
        <source>Loading probe</source>
        <translation>Die Sonde wird geladen</translation>
    </message>
    <message>
        <source>Measuring noise</source>
        <translation>Das Rauschen wird gemessen</translation>
    </message>
    <message>
        <source>verify</source>
        <translation>prüfen</translation>
    </message>
    <message>
        <source>Verification passed.</source>
        <translation>Die Überprüfung ist bestanden.</translation>
    </message>
    <message>
        <source>Verification failed.</source>
        <translation>Die Überprüfung ist nicht bestanden.</translation>
    </message>
    <message>
        <source>Evaluating touches</source>
        <translation>Die Berührungen werden ausgewertet</translation>
    </message>
    <message>
        <source>Stopping recording</source>
        <translation>Die Aufzeichnung wird beendet</translation>
    </message>
    <message>
        <source>Start touching</source>
        <translation>Berühren beginnen</translation>
    </message>
    <message>
        <source>Verify again</source>
        <translation>Erneut prüfen</translation>
    </message>
    <message>
        <source>Go to Gravity</source>
        <translation>Zur Schwerkraft</translation>
    </message>
    <message>
        <source>Open Probe</source>
        <translation>Sonde öffnen</translation>
    </message>
    <message>
        <source>Save the recording, evaluate it and create the report</source>
        <translation>Die Aufzeichnung speichern, auswerten und den Bericht erstellen</translation>
    </message>
    <message>
        <source>Finish</source>
        <translation>Beenden</translation>
    </message>
    <message>
        <source>Stop without a verdict; the touches are discarded</source>
        <translation>Ohne Ergebnis beenden; die Berührungen werden verworfen</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>Verwerfen</translation>
    </message>
    <message>
        <source>Next: Export</source>
        <translation>Weiter: Export</translation>
    </message>
    <message>
        <source>Place markers on the first tab.</source>
        <translation>Setzen Sie zuerst Marker auf dem ersten Reiter.</translation>
    </message>
</context>
<context>
    <name>VerifySettingsPanel</name>
    <message>
        <source>Lower force limit, N</source>
        <translation>Untere Kraftgrenze, N</translation>
    </message>
    <message>
        <source>Upper force limit, N</source>
        <translation>Obere Kraftgrenze, N</translation>
    </message>
    <message>
        <source>any order</source>
        <translation>beliebig</translation>
    </message>
    <message>
        <source>table order</source>
        <translation>wie in der Tabelle</translation>
    </message>
    <message>
        <source>Order in which to touch the markers</source>
        <translation>Reihenfolge, in der die Marker berührt werden</translation>
    </message>
    <message>
        <source>Any order: a touch counts for the nearest marker. Table order: it counts for the next marker.</source>
        <translation>Beliebig: Eine Berührung zählt für den nächstgelegenen Marker. Wie in der Tabelle: Sie zählt für den nächsten Marker der Reihe.</translation>
    </message>
    <message>
        <source>Press with</source>
        <translation>Drücken mit</translation>
    </message>
    <message>
        <source>to</source>
        <translation>bis</translation>
    </message>
    <message>
        <source>Touch order</source>
        <translation>Reihenfolge</translation>
    </message>
    <message>
        <source>Order of touches</source>
        <translation>Reihenfolge der Berührungen</translation>
    </message>
    <message>
        <source>Force window</source>
        <translation>Kraftfenster</translation>
    </message>
</context>
<context>
    <name>ViewButtons</name>
    <message>
        <source>Front</source>
        <translation>Vorn</translation>
    </message>
    <message>
        <source>View from the front: x right, z up</source>
        <translation>Von vorn ansehen: x nach rechts, z nach oben</translation>
    </message>
    <message>
        <source>Side</source>
        <translation>Seite</translation>
    </message>
    <message>
        <source>View from the side: y right, z up</source>
        <translation>Von der Seite ansehen: y nach rechts, z nach oben</translation>
    </message>
    <message>
        <source>Top</source>
        <translation>Oben</translation>
    </message>
    <message>
        <source>View the tip from above: x right, y up</source>
        <translation>Von oben auf die Spitze sehen: x nach rechts, y nach oben</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>Einpassen</translation>
    </message>
    <message>
        <source>Show the whole probe from the same direction</source>
        <translation>Die ganze Sonde aus derselben Richtung zeigen</translation>
    </message>
    <message>
        <source>Perspective</source>
        <translation>Perspektive</translation>
    </message>
    <message>
        <source>Nearer objects look larger, so no scale bar is shown</source>
        <translation>Nähere Teile wirken größer; deshalb wird kein Maßstab gezeigt</translation>
    </message>
    <message>
        <source>View</source>
        <translation>Ansicht</translation>
    </message>
    <message>
        <source>How the probe is viewed</source>
        <translation>Wie die Sonde betrachtet wird</translation>
    </message>
</context>
<context>
    <name>ViewerWork</name>
    <message>
        <source>Stopped; nothing was changed.</source>
        <translation>Angehalten; nichts wurde geändert.</translation>
    </message>
    <message>
        <source>Unexpected error: {what}.</source>
        <translation>Unerwarteter Fehler: {what}.</translation>
    </message>
</context>
<context>
    <name>WeightPanel</name>
    <message>
        <source>Known weight</source>
        <translation>Bekanntes Gewicht</translation>
    </message>
    <message>
        <source>Hang a known mass on the tool. This reveals wrong sensor units, signs or scale, which poses alone cannot show.</source>
        <translation>Hängen Sie eine bekannte Masse an das Werkzeug. So zeigen sich falsche Einheiten, Vorzeichen oder Skalen des Sensors, die Posen allein nicht zeigen können.</translation>
    </message>
    <message>
        <source>Mass</source>
        <translation>Masse</translation>
    </message>
    <message>
        <source>Uncertainty (1 sigma)</source>
        <translation>Unsicherheit (1 Sigma)</translation>
    </message>
    <message>
        <source>Number (optional)</source>
        <translation>Nummer (optional)</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>Zertifikat</translation>
    </message>
    <message>
        <source>1. Read without weight</source>
        <translation>1. Ohne Gewicht messen</translation>
    </message>
    <message>
        <source>2. Read with weight</source>
        <translation>2. Mit Gewicht messen</translation>
    </message>
    <message>
        <source>Remove everything from the tool and hold it still.</source>
        <translation>Alles vom Werkzeug nehmen und es still halten.</translation>
    </message>
    <message>
        <source>Done. Hang the weight on the tool, wait until it is at rest, then press 2.</source>
        <translation>Fertig. Hängen Sie das Gewicht an das Werkzeug, warten Sie, bis es ruht, und drücken Sie dann 2.</translation>
    </message>
    <message>
        <source>Wait until the weight is at rest.</source>
        <translation>Warten, bis das Gewicht ruht.</translation>
    </message>
</context>
<context>
    <name>_Missing</name>
    <message>
        <source>This page could not be created. See Messages for details. The other steps still work.</source>
        <translation>Diese Seite konnte nicht erstellt werden. Einzelheiten stehen unter Meldungen. Die anderen Schritte funktionieren weiter.</translation>
    </message>
</context>
</TS>
