<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE">
<context>
    <name>AboutDialog</name>
    <message>
        <source>see its own files</source>
        <translation>siehe eigene Dateien</translation>
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
        <source>Finds where a probe is touched, from one force/torque sensor, and how sure that is. Licensed under the Apache License 2.0. A tool for the bench and for research: no medical device.</source>
        <translation>Findet mit einem einzigen Kraft-Momenten-Sensor, wo eine Sonde berührt wird, und wie sicher das ist. Lizenziert unter der Apache License 2.0. Ein Werkzeug für Labor und Forschung: kein Medizinprodukt.</translation>
    </message>
    <message>
        <source>Licences of the parts</source>
        <translation>Lizenzen der Bestandteile</translation>
    </message>
    <message>
        <source>Its parts and their licences:</source>
        <translation>Die Bestandteile und ihre Lizenzen:</translation>
    </message>
</context>
<context>
    <name>AlignmentPanel</name>
    <message>
        <source>By numbers</source>
        <translation>Durch Zahlen</translation>
    </message>
    <message>
        <source>By matching points</source>
        <translation>Durch Punktpaare</translation>
    </message>
    <message>
        <source>By the face on the sensor</source>
        <translation>Durch die Fläche auf dem Sensor</translation>
    </message>
    <message>
        <source>By touches of marked points</source>
        <translation>Durch Berühren markierter Punkte</translation>
    </message>
    <message>
        <source>By its shape</source>
        <translation>Nach der Form</translation>
    </message>
    <message>
        <source>From a file</source>
        <translation>Aus einer Datei</translation>
    </message>
    <message>
        <source>How the place of the mesh is given</source>
        <translation>Wie die Lage des Netzes angegeben wird</translation>
    </message>
    <message>
        <source>Where the mesh&apos;s origin lies, and how the mesh is turned:</source>
        <translation>Wo der Ursprung des Netzes liegt und wie das Netz gedreht ist:</translation>
    </message>
    <message>
        <source>Turned about the fixed axis {} of the sensor, in degrees; x first, then y, then z</source>
        <translation>Drehung um die feste {}-Achse des Sensors in Grad; zuerst x, dann y, dann z</translation>
    </message>
    <message>
        <source>The mesh&apos;s origin along {} of the sensor, in mm</source>
        <translation>Ursprung des Netzes entlang {} des Sensors, in mm</translation>
    </message>
    <message>
        <source>about {}</source>
        <translation>um {}</translation>
    </message>
    <message>
        <source>Place it so</source>
        <translation>So platzieren</translation>
    </message>
    <message>
        <source>Click a place on the mesh, then type where it lies in the sensor frame. Three places, far from one another; a fourth shows a wrong one.</source>
        <translation>Klicken Sie eine Stelle auf dem Netz an und geben Sie ein, wo sie im Sensorsystem liegt. Drei Stellen, weit voneinander entfernt; eine vierte zeigt, ob eine falsch ist.</translation>
    </message>
    <message>
        <source>Place it by these points</source>
        <translation>Mit diesen Punkten platzieren</translation>
    </message>
    <message>
        <source>Angle of the second place from +x of the sensor about +z, degrees</source>
        <translation>Winkel der zweiten Stelle von +x des Sensors aus um +z, in Grad</translation>
    </message>
    <message>
        <source>Second place at</source>
        <translation>Zweite Stelle bei</translation>
    </message>
    <message>
        <source>Height of the mounting plane above the sensor&apos;s origin, mm</source>
        <translation>Höhe der Montagefläche über dem Ursprung des Sensors, mm</translation>
    </message>
    <message>
        <source>Height of the face</source>
        <translation>Höhe der Fläche</translation>
    </message>
    <message>
        <source>Put this face on the sensor</source>
        <translation>Diese Fläche auf den Sensor setzen</translation>
    </message>
    <message>
        <source>Pick again</source>
        <translation>Neu wählen</translation>
    </message>
    <message>
        <source>Touch marked points of the probe, and choose the table of them: px, py, pz in the mesh, mm, and fx to mz in the sensor frame. The place above is where the search begins.</source>
        <translation>Berühren Sie markierte Punkte der Sonde und wählen Sie die Tabelle dazu: px, py, pz im Netz in mm und fx bis mz im Sensorsystem. Die Suche beginnt bei der Lage, die oben angegeben ist.</translation>
    </message>
    <message>
        <source>Choose the touches...</source>
        <translation>Berührungen wählen...</translation>
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
        <source>The longest axis along z, the middle one along x. A guess that is good to begin with: look at it, and correct it by numbers or touches.</source>
        <translation>Die längste Achse entlang z, die mittlere entlang x. Für den Anfang eine gute Schätzung: Sehen Sie sie an und berichtigen Sie sie durch Zahlen oder Berührungen.</translation>
    </message>
    <message>
        <source>Height of the probe&apos;s lowest point above the sensor&apos;s origin, mm</source>
        <translation>Höhe des tiefsten Punkts der Sonde über dem Ursprung des Sensors, mm</translation>
    </message>
    <message>
        <source>Lowest point at</source>
        <translation>Tiefster Punkt bei</translation>
    </message>
    <message>
        <source>Place it by its shape</source>
        <translation>Nach der Form platzieren</translation>
    </message>
    <message>
        <source>An alignment that contactbench wrote before.</source>
        <translation>Eine Ausrichtung, die contactbench früher geschrieben hat.</translation>
    </message>
    <message>
        <source>Choose the alignment...</source>
        <translation>Ausrichtung wählen...</translation>
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
        <source>Click the plane face of the mesh that sits on the sensor.</source>
        <translation>Klicken Sie die ebene Fläche des Netzes an, die auf dem Sensor sitzt.</translation>
    </message>
    <message>
        <source>The face is chosen. Click a second place that shows how the probe is turned about z, if you can.</source>
        <translation>Die Fläche ist gewählt. Klicken Sie, wenn möglich, eine zweite Stelle an, die zeigt, wie die Sonde um z gedreht ist.</translation>
    </message>
    <message>
        <source>The face and the second place are chosen.</source>
        <translation>Die Fläche und die zweite Stelle sind gewählt.</translation>
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
        <source>still: SPACE</source>
        <translation>ruhig: LEERTASTE</translation>
    </message>
    <message>
        <source>Press SPACE to take this pose.</source>
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
        <source>Keep still: it is being averaged.</source>
        <translation>Still halten: Es wird gemittelt.</translation>
    </message>
    <message>
        <source>bumped</source>
        <translation>angestoßen</translation>
    </message>
    <message>
        <source>Keep still: it begins anew by itself.</source>
        <translation>Still halten: Es beginnt von selbst neu.</translation>
    </message>
    <message>
        <source>touched</source>
        <translation>berührt</translation>
    </message>
    <message>
        <source>Take away what touches the tool.</source>
        <translation>Entfernen Sie, was das Werkzeug berührt.</translation>
    </message>
    <message>
        <source>no samples</source>
        <translation>keine Messwerte</translation>
    </message>
    <message>
        <source>Nothing comes from the devices.</source>
        <translation>Von den Geräten kommt nichts.</translation>
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
        <source>What it does</source>
        <translation>Was sie tut</translation>
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
        <source>Take the selected poses back</source>
        <translation>Gewählte Posen zurücknehmen</translation>
    </message>
    <message>
        <source>Arrow keys</source>
        <translation>Pfeiltasten</translation>
    </message>
    <message>
        <source>Choose a point of the chart of facets; move a handle of a range</source>
        <translation>Punkt im Diagramm der Facetten wählen; Griff eines Bereichs verschieben</translation>
    </message>
    <message>
        <source>Left or right button, dragged</source>
        <translation>Linke oder rechte Taste, gezogen</translation>
    </message>
    <message>
        <source>Turn the view</source>
        <translation>Ansicht drehen</translation>
    </message>
    <message>
        <source>Middle button, dragged</source>
        <translation>Mittlere Taste, gezogen</translation>
    </message>
    <message>
        <source>Move the view</source>
        <translation>Ansicht verschieben</translation>
    </message>
    <message>
        <source>Wheel</source>
        <translation>Mausrad</translation>
    </message>
    <message>
        <source>Nearer or farther</source>
        <translation>Näher oder weiter weg</translation>
    </message>
    <message>
        <source>Ctrl and wheel</source>
        <translation>Strg und Mausrad</translation>
    </message>
    <message>
        <source>Larger or smaller brush</source>
        <translation>Größerer oder kleinerer Pinsel</translation>
    </message>
    <message>
        <source>Shift, held</source>
        <translation>Umschalt, gehalten</translation>
    </message>
    <message>
        <source>The brush erases, the eraser paints</source>
        <translation>Der Pinsel radiert, der Radierer malt</translation>
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
        <source>Go there</source>
        <translation>Dorthin</translation>
    </message>
    <message>
        <source>Go to {name}</source>
        <translation>Zu {name} gehen</translation>
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
        <source>Another colour...</source>
        <translation>Andere Farbe...</translation>
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
        <source>Colour of the region</source>
        <translation>Farbe der Region</translation>
    </message>
</context>
<context>
    <name>Coverage</name>
    <message>
        <source>Coverage of the directions of gravity</source>
        <translation>Abdeckung der Richtungen der Schwerkraft</translation>
    </message>
    <message>
        <source>Poses: {taken} taken, {left} left out, {rejected} rejected</source>
        <translation>Posen: {taken} aufgenommen, {left} ausgelassen, {rejected} abgelehnt</translation>
    </message>
    <message>
        <source>gravity to the tool (+z)</source>
        <translation>zum Werkzeug hin (+z)</translation>
    </message>
    <message>
        <source>away from it (-z)</source>
        <translation>vom Werkzeug weg (-z)</translation>
    </message>
    <message>
        <source>Where gravity pulled, seen from the sensor. Filled: taken; hollow: left out; cross: rejected; ring: the next pose; dark dot: now. Poses that are spread out tell most.</source>
        <translation>Wohin die Schwerkraft zog, vom Sensor aus gesehen. Gefüllt: aufgenommen; hohl: ausgelassen; Kreuz: abgelehnt; Ring: nächste Pose; dunkler Punkt: jetzt. Weit verteilte Posen sagen am meisten.</translation>
    </message>
</context>
<context>
    <name>DamageCheck</name>
    <message>
        <source>Checking the session&apos;s files</source>
        <translation>Die Dateien der Sitzung werden geprüft</translation>
    </message>
    <message>
        <source>A file of this session is not as it was written, so nothing that rests on it counts.</source>
        <translation>Eine Datei dieser Sitzung ist nicht mehr so, wie sie geschrieben wurde; was darauf beruht, zählt deshalb nicht.</translation>
    </message>
    <message>
        <source>{} files of this session are not as they were written, so nothing that rests on them counts. `contactbench session verify` lists them all.</source>
        <translation>{} Dateien dieser Sitzung sind nicht mehr so, wie sie geschrieben wurden; was darauf beruht, zählt deshalb nicht. `contactbench session verify` listet sie alle auf.</translation>
    </message>
</context>
<context>
    <name>DeviceChannels</name>
    <message>
        <source>Noise and margin of each channel</source>
        <translation>Rauschen und Reserve jedes Kanals</translation>
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
        <source>Standard deviation of one reading while nothing moves, N or N·m</source>
        <translation>Standardabweichung eines Messwerts, während sich nichts bewegt, N oder N·m</translation>
    </message>
    <message>
        <source>largest</source>
        <translation>größter</translation>
    </message>
    <message>
        <source>Largest reading of either sign in the last 5 s, N or N·m</source>
        <translation>Größter Messwert beider Vorzeichen in den letzten 5 s, N oder N·m</translation>
    </message>
    <message>
        <source>of range</source>
        <translation>v. Bereich</translation>
    </message>
    <message>
        <source>Share of the sensor&apos;s range; beyond 100 % it is cut off</source>
        <translation>Anteil am Messbereich des Sensors; über 100 % wird abgeschnitten</translation>
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
        <source>Readings a second, measured</source>
        <translation>Messwerte pro Sekunde, gemessen</translation>
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
        <source>gaps in 5 s: {count}, the longest {longest:.0f} ms</source>
        <translation>Lücken in 5 s: {count}, die längste {longest:.0f} ms</translation>
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
        <source>on the sensor&apos;s label</source>
        <translation>auf dem Schild des Sensors</translation>
    </message>
    <message>
        <source>Serial number of the sensor</source>
        <translation>Seriennummer des Sensors</translation>
    </message>
    <message>
        <source>Mounting angle about {axis}</source>
        <translation>Montagewinkel um {axis}</translation>
    </message>
    <message>
        <source>How the sensor is turned on the flange, about the flange&apos;s fixed axes x, then y, then z</source>
        <translation>Wie der Sensor auf dem Flansch gedreht ist, um die festen Flanschachsen x, dann y, dann z</translation>
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
        <source>Mounting</source>
        <translation>Montage</translation>
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
        <source>Measured</source>
        <translation>Gemessen</translation>
    </message>
    <message>
        <source>A recording is being made with the devices: finish it before you change them.</source>
        <translation>Mit den Geräten läuft eine Aufzeichnung: Beenden Sie sie, bevor Sie die Geräte wechseln.</translation>
    </message>
    <message>
        <source>Opening the devices…</source>
        <translation>Geräte werden geöffnet…</translation>
    </message>
    <message>
        <source>Testing the connection</source>
        <translation>Die Verbindung wird getestet</translation>
    </message>
    <message>
        <source>choose devices</source>
        <translation>Geräte wählen</translation>
    </message>
    <message>
        <source>Opening the devices</source>
        <translation>Die Geräte werden geöffnet</translation>
    </message>
    <message>
        <source>The devices could not be opened: {why}</source>
        <translation>Die Geräte konnten nicht geöffnet werden: {why}</translation>
    </message>
    <message>
        <source>The devices could not be noted: {why}</source>
        <translation>Die Geräte konnten nicht vermerkt werden: {why}</translation>
    </message>
    <message>
        <source>Closing the devices</source>
        <translation>Die Geräte werden geschlossen</translation>
    </message>
    <message>
        <source>The sensor is back: readings come again.</source>
        <translation>Der Sensor ist wieder da: Es kommen wieder Messwerte.</translation>
    </message>
</context>
<context>
    <name>DiskWatch</name>
    <message>
        <source>Nothing is written into this session at the moment, because the last write failed. Free some space, or check the disk: the session goes on by itself then, and says so.</source>
        <translation>In diese Sitzung wird gerade nichts geschrieben, denn das letzte Schreiben ist fehlgeschlagen. Schaffen Sie Platz oder prüfen Sie den Datenträger: Die Sitzung geht dann von selbst weiter und sagt es.</translation>
    </message>
    <message>
        <source>The disk can be written again, and the session goes on. Do again what was refused; what was recorded before is there.</source>
        <translation>Der Datenträger kann wieder beschrieben werden, und die Sitzung geht weiter. Wiederholen Sie, was abgelehnt wurde; was vorher aufgezeichnet wurde, ist da.</translation>
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
        <source>What will be in it</source>
        <translation>Was darin sein wird</translation>
    </message>
    <message>
        <source>Settings</source>
        <translation>Einstellungen</translation>
    </message>
    <message>
        <source>Write it although it is not verified</source>
        <translation>Auch ungeprüft schreiben</translation>
    </message>
    <message>
        <source>For trials only: the bundle says that nobody has shown that it is right</source>
        <translation>Nur für Versuche: Das Paket sagt, dass niemand gezeigt hat, dass es stimmt</translation>
    </message>
    <message>
        <source>Export a file…</source>
        <translation>Als Datei…</translation>
    </message>
    <message>
        <source>One zip file, which a robot&apos;s runtime loads as it is</source>
        <translation>Eine Zip-Datei, die der Robotercomputer so lädt, wie sie ist</translation>
    </message>
    <message>
        <source>Export a folder…</source>
        <translation>Als Ordner…</translation>
    </message>
    <message>
        <source>Open the report</source>
        <translation>Bericht öffnen</translation>
    </message>
    <message>
        <source>Show where it is</source>
        <translation>Zeigen, wo es liegt</translation>
    </message>
    <message>
        <source>Looking at the bundle</source>
        <translation>Das Paket wird angesehen</translation>
    </message>
    <message>
        <source>How many readings a second the robot will get is not known: a verification would have told. Verify in step 5, or fill in Readings under Settings, as the sensor is set.</source>
        <translation>Wie viele Messwerte pro Sekunde der Roboter bekommen wird, ist nicht bekannt: Eine Überprüfung hätte es gesagt. Überprüfen Sie in Schritt 5, oder füllen Sie unter „Einstellungen“ das Feld „Messwerte“ aus, so wie der Sensor eingestellt ist.</translation>
    </message>
    <message>
        <source>together {size}, SHA-256 {sha256}…</source>
        <translation>zusammen {size}, SHA-256 {sha256}…</translation>
    </message>
    <message>
        <source>Nothing was exported from this session before.</source>
        <translation>Aus dieser Sitzung wurde noch nichts exportiert.</translation>
    </message>
    <message>
        <source>Against the last export:</source>
        <translation>Gegenüber dem letzten Export:</translation>
    </message>
    <message>
        <source>Not verified: {why}</source>
        <translation>Nicht geprüft: {why}</translation>
    </message>
    <message>
        <source>Verified, and exported as it is.</source>
        <translation>Geprüft und genau so exportiert.</translation>
    </message>
    <message>
        <source>Verified: ready to be exported.</source>
        <translation>Geprüft: bereit zum Export.</translation>
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
        <source>Export a file</source>
        <translation>Als Datei exportieren</translation>
    </message>
    <message>
        <source>Bundles (*.zip)</source>
        <translation>Pakete (*.zip)</translation>
    </message>
    <message>
        <source>Export a folder: give it a name</source>
        <translation>Als Ordner exportieren: Geben Sie ihm einen Namen</translation>
    </message>
    <message>
        <source>Exporting</source>
        <translation>Wird exportiert</translation>
    </message>
</context>
<context>
    <name>ExportSettingsPanel</name>
    <message>
        <source>Model of the sensor</source>
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
        <source>Serial number of the sensor</source>
        <translation>Seriennummer des Sensors</translation>
    </message>
    <message>
        <source>as the session knows it</source>
        <translation>wie die Sitzung es weiß</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>Seriennummer</translation>
    </message>
    <message>
        <source>Name of the sensor in the robot description, for ros2.yaml</source>
        <translation>Name des Sensors in der Roboterbeschreibung, für ros2.yaml</translation>
    </message>
    <message>
        <source>to be filled in later</source>
        <translation>wird später eingetragen</translation>
    </message>
    <message>
        <source>Name in ROS</source>
        <translation>Name in ROS</translation>
    </message>
    <message>
        <source>Who is answerable</source>
        <translation>Wer dafür verantwortlich ist</translation>
    </message>
    <message>
        <source>who made the newest result</source>
        <translation>wer das neueste Ergebnis erstellt hat</translation>
    </message>
    <message>
        <source>Operator</source>
        <translation>Bedienperson</translation>
    </message>
    <message>
        <source>as verified</source>
        <translation>wie geprüft</translation>
    </message>
    <message>
        <source>Readings a second, Hz</source>
        <translation>Messwerte pro Sekunde, Hz</translation>
    </message>
    <message>
        <source>Readings</source>
        <translation>Messwerte</translation>
    </message>
    <message>
        <source>Filter the wrench</source>
        <translation>Kraft/Moment filtern</translation>
    </message>
    <message>
        <source>A Kalman filter: less noise, a little lag</source>
        <translation>Ein Kalman-Filter: weniger Rauschen, etwas Verzögerung</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keiner</translation>
    </message>
    <message>
        <source>Low-pass of the contact point, Hz</source>
        <translation>Tiefpass des Kontaktpunkts, Hz</translation>
    </message>
    <message>
        <source>Low-pass</source>
        <translation>Tiefpass</translation>
    </message>
    <message>
        <source>Only contacts on a region</source>
        <translation>Nur Kontakte auf einer Region</translation>
    </message>
    <message>
        <source>The runtime refuses contacts outside every painted region</source>
        <translation>Der Robotercomputer verwirft Kontakte außerhalb aller gemalten Regionen</translation>
    </message>
    <message>
        <source>What a controller must never exceed, N</source>
        <translation>Was eine Regelung nie überschreiten darf, N</translation>
    </message>
    <message>
        <source>Largest force</source>
        <translation>Größte Kraft</translation>
    </message>
    <message>
        <source>What a controller must never exceed, N·m</source>
        <translation>Was eine Regelung nie überschreiten darf, N·m</translation>
    </message>
    <message>
        <source>Largest torque</source>
        <translation>Größtes Moment</translation>
    </message>
    <message>
        <source>Gains of the controller</source>
        <translation>Verstärkungen der Regelung</translation>
    </message>
    <message>
        <source>How a robot presses and follows: gains.json of contactbench bench control tune</source>
        <translation>Wie ein Roboter drückt und folgt: gains.json von contactbench bench control tune</translation>
    </message>
    <message>
        <source>Leave the gains out</source>
        <translation>Die Verstärkungen weglassen</translation>
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
        <source>left out</source>
        <translation>weggelassen</translation>
    </message>
    <message>
        <source>{force:g} N, {variant}</source>
        <translation>{force:g} N, {variant}</translation>
    </message>
    <message>
        <source>aware</source>
        <translation>vorausschauend</translation>
    </message>
    <message>
        <source>plain</source>
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
        <source>Show the original over it</source>
        <translation>Original darüberlegen</translation>
    </message>
    <message>
        <source>Show the deviation as colours</source>
        <translation>Abweichung als Farben zeigen</translation>
    </message>
    <message>
        <source>How far the outer surface is from the simplified one, in mm</source>
        <translation>Wie weit die Außenfläche von der vereinfachten entfernt ist, in mm</translation>
    </message>
    <message>
        <source>a number of facets</source>
        <translation>eine Anzahl Facetten</translation>
    </message>
    <message>
        <source>a largest deviation</source>
        <translation>eine größte Abweichung</translation>
    </message>
    <message>
        <source>a largest contact error</source>
        <translation>einen größten Kontaktfehler</translation>
    </message>
    <message>
        <source>Number of facets, or mm</source>
        <translation>Anzahl der Facetten, oder mm</translation>
    </message>
    <message>
        <source>Keep to</source>
        <translation>Halten an</translation>
    </message>
    <message>
        <source>Up to</source>
        <translation>Bis zu</translation>
    </message>
    <message>
        <source>Facets per area inside the regions over that outside</source>
        <translation>Facetten pro Fläche in den Regionen im Verhältnis zu außerhalb</translation>
    </message>
    <message>
        <source>Finer in regions</source>
        <translation>Feiner in Regionen</translation>
    </message>
    <message>
        <source>Put the painted regions on it</source>
        <translation>Gemalte Regionen übernehmen</translation>
    </message>
    <message>
        <source>Number of facets</source>
        <translation>Anzahl der Facetten</translation>
    </message>
    <message>
        <source>Largest distance, mm</source>
        <translation>Größter Abstand, mm</translation>
    </message>
    <message>
        <source>Of 95 % of contacts, mm</source>
        <translation>Von 95 % der Kontakte, mm</translation>
    </message>
    <message>
        <source>{:,} facets</source>
        <translation>{:,} Facetten</translation>
    </message>
</context>
<context>
    <name>Faults</name>
    <message>
        <source>The disk is full ({}). What was recorded before is safe: free some space, then do it again.</source>
        <translation>Der Datenträger ist voll ({}). Was vorher aufgezeichnet wurde, ist sicher: Schaffen Sie Platz und versuchen Sie es noch einmal.</translation>
    </message>
    <message>
        <source>There is not enough memory for this: close other programs, or use a smaller file, then do it again.</source>
        <translation>Der Arbeitsspeicher reicht dafür nicht: Schließen Sie andere Programme, oder nehmen Sie eine kleinere Datei, und versuchen Sie es noch einmal.</translation>
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
        <source>Found</source>
        <translation>Gefunden</translation>
    </message>
    <message>
        <source>Do that</source>
        <translation>Das tun</translation>
    </message>
</context>
<context>
    <name>GravityFigures</name>
    <message>
        <source>contact error from the calibration (1 sigma)</source>
        <translation>Kontaktfehler durch die Kalibrierung (1 Sigma)</translation>
    </message>
    <message>
        <source>How far a contact point may be off because of the calibration alone, in mm: the worst case over the touches that it is for. 0.5 mm is good.</source>
        <translation>Wie weit ein Kontaktpunkt allein wegen der Kalibrierung danebenliegen kann, in mm: der schlechteste Fall der Berührungen, für die sie gedacht ist. 0.5 mm ist gut.</translation>
    </message>
    <message>
        <source>With each pose, on a logarithmic scale; dashed: 0.5 mm, the limit for good</source>
        <translation>Mit jeder Pose, auf logarithmischer Skala; gestrichelt: 0.5 mm, die Grenze für gut</translation>
    </message>
    <message>
        <source>pose {count} of ~{expected}</source>
        <translation>Pose {count} von ~{expected}</translation>
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
        <source>Take this pose (gravity)</source>
        <translation>Diese Pose aufnehmen (Schwerkraft)</translation>
    </message>
    <message>
        <source>This did not work</source>
        <translation>Das hat nicht geklappt</translation>
    </message>
    <message>
        <source>Checked in a pose it had not seen</source>
        <translation>Geprüft in einer Pose, die neu für sie war</translation>
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
        <source>not enough to be used</source>
        <translation>nicht genug, um benutzt zu werden</translation>
    </message>
    <message>
        <source>A calibration needs three poses or more.</source>
        <translation>Eine Kalibrierung braucht mindestens drei Posen.</translation>
    </message>
    <message>
        <source>Go to Devices</source>
        <translation>Zu den Geräten</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Stopp</translation>
    </message>
    <message>
        <source>Beginning...</source>
        <translation>Beginnt...</translation>
    </message>
    <message>
        <source>Finish</source>
        <translation>Beenden</translation>
    </message>
    <message>
        <source>Computing...</source>
        <translation>Wird berechnet...</translation>
    </message>
    <message>
        <source>Waiting for a still pose...</source>
        <translation>Wartet auf eine ruhige Pose...</translation>
    </message>
    <message>
        <source>Start anew</source>
        <translation>Neu beginnen</translation>
    </message>
    <message>
        <source>Go on with {recording}</source>
        <translation>Weiter mit {recording}</translation>
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
        <source>Check one more pose</source>
        <translation>Pose nachprüfen</translation>
    </message>
    <message>
        <source>Go on: Probe</source>
        <translation>Weiter: Sonde</translation>
    </message>
    <message>
        <source>set the largest tilt to {degrees}°</source>
        <translation>größte Neigung auf {degrees}° setzen</translation>
    </message>
    <message>
        <source>say where down is</source>
        <translation>angeben, wo unten ist</translation>
    </message>
    <message>
        <source>say how well orientations are known</source>
        <translation>angeben, wie gut die Orientierungen bekannt sind</translation>
    </message>
</context>
<context>
    <name>GravityPanel</name>
    <message>
        <source>Gravity</source>
        <translation>Schwerkraft</translation>
    </message>
    <message>
        <source>Hold the tool still in about six different tilts, touching nothing. From them follow its weight and the sensor&apos;s zero, which are then taken off every reading.</source>
        <translation>Halten Sie das Werkzeug in etwa sechs verschiedenen Neigungen still, ohne dass es etwas berührt. Daraus folgen sein Gewicht und der Nullpunkt des Sensors, die dann von jedem Messwert abgezogen werden.</translation>
    </message>
    <message>
        <source>Take each still pose by itself</source>
        <translation>Jede ruhige Pose von selbst aufnehmen</translation>
    </message>
    <message>
        <source>Off: press SPACE, or the foot switch, in each pose that shall count.</source>
        <translation>Aus: In jeder Pose, die zählen soll, die LEERTASTE oder den Fußschalter drücken.</translation>
    </message>
    <message>
        <source>Turn it there for me</source>
        <translation>Für mich dorthin drehen</translation>
    </message>
    <message>
        <source>Bump it</source>
        <translation>Anstoßen</translation>
    </message>
    <message>
        <source>Push the virtual tool for a moment, to see what that does</source>
        <translation>Das virtuelle Werkzeug kurz anstoßen, um zu sehen, was geschieht</translation>
    </message>
    <message>
        <source>Leave out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>Take back</source>
        <translation>Zurücknehmen</translation>
    </message>
    <message>
        <source>The selected poses do not count (Delete)</source>
        <translation>Die gewählten Posen zählen nicht (Entf)</translation>
    </message>
    <message>
        <source>The selected poses count again (Return)</source>
        <translation>Die gewählten Posen zählen wieder (Return)</translation>
    </message>
    <message>
        <source>The tool can tilt by up to</source>
        <translation>Größte Neigung des Werkzeugs</translation>
    </message>
    <message>
        <source>Largest angle between the sensor&apos;s z axis and straight down, degrees; poses beyond are not proposed.</source>
        <translation>Größter Winkel zwischen der z-Achse des Sensors und senkrecht nach unten, in Grad; Posen darüber hinaus werden nicht vorgeschlagen.</translation>
    </message>
    <message>
        <source>The robot</source>
        <translation>Der Roboter</translation>
    </message>
    <message>
        <source>stands upright</source>
        <translation>steht aufrecht</translation>
    </message>
    <message>
        <source>hangs from the ceiling</source>
        <translation>hängt an der Decke</translation>
    </message>
    <message>
        <source>is on a wall, its +x points down</source>
        <translation>an der Wand, +x nach unten</translation>
    </message>
    <message>
        <source>is on a wall, its -x points down</source>
        <translation>an der Wand, -x nach unten</translation>
    </message>
    <message>
        <source>is on a wall, its +y points down</source>
        <translation>an der Wand, +y nach unten</translation>
    </message>
    <message>
        <source>is on a wall, its -y points down</source>
        <translation>an der Wand, -y nach unten</translation>
    </message>
    <message>
        <source>Where gravity points in the frame of the orientations. Others: session set calibration.down</source>
        <translation>Wohin die Schwerkraft im Koordinatensystem der Orientierungen zeigt. Andere Richtungen: session set calibration.down</translation>
    </message>
    <message>
        <source>by a robot ({degrees}°)</source>
        <translation>durch einen Roboter ({degrees}°)</translation>
    </message>
    <message>
        <source>by a tracker ({degrees}°)</source>
        <translation>durch einen Tracker ({degrees}°)</translation>
    </message>
    <message>
        <source>by hand ({degrees}°)</source>
        <translation>von Hand ({degrees}°)</translation>
    </message>
    <message>
        <source>Orientations are known</source>
        <translation>Orientierungen bekannt</translation>
    </message>
    <message>
        <source>as the poses show</source>
        <translation>wie die Posen zeigen</translation>
    </message>
    <message>
        <source>How well, 1 sigma about each axis: errors of the orientations move the weight in the readings.</source>
        <translation>Wie gut, 1 Sigma um jede Achse: Fehler der Orientierungen verschieben das Gewicht in den Messwerten.</translation>
    </message>
    <message>
        <source>Next: {words}</source>
        <translation>Als Nächstes: {words}</translation>
    </message>
    <message>
        <source>You are there: keep still.</source>
        <translation>Sie sind da: still halten.</translation>
    </message>
    <message>
        <source>{angle:.0f}° to go.</source>
        <translation>noch {angle:.0f}°.</translation>
    </message>
</context>
<context>
    <name>GravityRun</name>
    <message>
        <source>Reading the calibration</source>
        <translation>Die Kalibrierung wird gelesen</translation>
    </message>
    <message>
        <source>Compensating</source>
        <translation>Wird kompensiert</translation>
    </message>
    <message>
        <source>Beginning to record</source>
        <translation>Die Aufzeichnung beginnt</translation>
    </message>
    <message>
        <source>The devices are being opened; the first pose is waited for after that.</source>
        <translation>Die Geräte werden geöffnet; danach wird auf die erste Pose gewartet.</translation>
    </message>
    <message>
        <source>No device is open: choose and open a sensor under Devices first.</source>
        <translation>Kein Gerät ist geöffnet: Wählen und öffnen Sie zuerst unter Geräte einen Sensor.</translation>
    </message>
    <message>
        <source>There is no source of poses. A weight can only be told from the sensor&apos;s zero if it is known how the sensor stands: choose a robot, a file of poses or the virtual bench under Devices.</source>
        <translation>Es gibt keine Quelle für Posen. Ein Gewicht lässt sich vom Nullpunkt des Sensors nur unterscheiden, wenn bekannt ist, wie der Sensor steht: Wählen Sie unter Geräte einen Roboter, eine Datei mit Posen oder den virtuellen Messplatz.</translation>
    </message>
    <message>
        <source>Gravity: {why}</source>
        <translation>Schwerkraft: {why}</translation>
    </message>
    <message>
        <source>Computing the calibration</source>
        <translation>Die Kalibrierung wird berechnet</translation>
    </message>
    <message>
        <source>Keeping the recording</source>
        <translation>Die Aufzeichnung wird behalten</translation>
    </message>
    <message>
        <source>All devices give samples again; the recording goes on.</source>
        <translation>Alle Geräte liefern wieder Messwerte; die Aufzeichnung geht weiter.</translation>
    </message>
    <message>
        <source>In a pose that it had not seen, the calibration proved good.</source>
        <translation>In einer Pose, die neu für sie war, erwies sich die Kalibrierung als gut.</translation>
    </message>
    <message>
        <source>In a pose that it had not seen, the calibration proved usable.</source>
        <translation>In einer Pose, die neu für sie war, erwies sich die Kalibrierung als brauchbar.</translation>
    </message>
    <message>
        <source>In a pose that it had not seen, the calibration proved wrong: do not use it.</source>
        <translation>In einer Pose, die neu für sie war, erwies sich die Kalibrierung als falsch: Benutzen Sie sie nicht.</translation>
    </message>
    <message>
        <source>Keeping the check</source>
        <translation>Die Prüfung wird behalten</translation>
    </message>
    <message>
        <source>leave out {poses}</source>
        <translation>{poses} auslassen</translation>
    </message>
    <message>
        <source>take back {poses}</source>
        <translation>{poses} zurücknehmen</translation>
    </message>
    <message>
        <source>The calibration is being computed, so no pose was changed. Do it again in a moment.</source>
        <translation>Die Kalibrierung wird gerade berechnet, deshalb wurde keine Pose geändert. Versuchen Sie es gleich noch einmal.</translation>
    </message>
    <message>
        <source>Setting the parameters</source>
        <translation>Die Parameter werden gesetzt</translation>
    </message>
    <message>
        <source>Opening the devices with the new mount</source>
        <translation>Die Geräte werden mit der neuen Montage geöffnet</translation>
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
        <source>What the colours mean. Density: per mm2; forces: N; error and uncertainty: mm.</source>
        <translation>Was die Farben bedeuten. Dichte: pro mm2; Kräfte: N; Fehler und Unsicherheit: mm.</translation>
    </message>
    <message>
        <source>number of contacts</source>
        <translation>Anzahl der Kontakte</translation>
    </message>
    <message>
        <source>seconds of contact</source>
        <translation>Sekunden mit Kontakt</translation>
    </message>
    <message>
        <source>contacts per second</source>
        <translation>Kontakte pro Sekunde</translation>
    </message>
    <message>
        <source>What a density adds up to</source>
        <translation>Was eine Dichte insgesamt ergibt</translation>
    </message>
    <message>
        <source>What the density adds up to over the whole surface.</source>
        <translation>Was die Dichte über die ganze Oberfläche ergibt.</translation>
    </message>
    <message>
        <source>Bandwidth in mm</source>
        <translation>Bandbreite in mm</translation>
    </message>
    <message>
        <source>Standard deviation of the Gaussian by which each contact is spread along the surface, mm.</source>
        <translation>Standardabweichung der Gauß-Glocke, mit der jeder Kontakt entlang der Oberfläche verteilt wird, mm.</translation>
    </message>
    <message>
        <source>Range of force in N</source>
        <translation>Kraftbereich in N</translation>
    </message>
    <message>
        <source>Only contacts with a force in this range count, N.</source>
        <translation>Nur Kontakte mit einer Kraft in diesem Bereich zählen, N.</translation>
    </message>
    <message>
        <source>Weigh by confidence</source>
        <translation>Nach Sicherheit gewichten</translation>
    </message>
    <message>
        <source>Let each contact count as much as its place is sure.</source>
        <translation>Jeder Kontakt zählt so viel, wie seine Stelle sicher ist.</translation>
    </message>
    <message>
        <source>Compare two side by side</source>
        <translation>Zwei nebeneinander vergleichen</translation>
    </message>
    <message>
        <source>A second heatmap with the same view and the same colours.</source>
        <translation>Eine zweite Heatmap mit derselben Ansicht und denselben Farben.</translation>
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
        <source>Recordings with their calibration and probe, contacts, verifications.</source>
        <translation>Aufzeichnungen mit Kalibrierung und Sonde, Kontakte, Überprüfungen.</translation>
    </message>
    <message>
        <source>Open session</source>
        <translation>Sitzung öffnen</translation>
    </message>
    <message>
        <source>The newest recording and verification of a session.</source>
        <translation>Die neueste Aufzeichnung und Überprüfung einer Sitzung.</translation>
    </message>
    <message>
        <source>Picture</source>
        <translation>Bild</translation>
    </message>
    <message>
        <source>What is shown, from two sides, as .png.</source>
        <translation>Was gezeigt wird, von zwei Seiten, als .png.</translation>
    </message>
    <message>
        <source>Film</source>
        <translation>Film</translation>
    </message>
    <message>
        <source>The time window, played at the chosen speed, as .mp4 or .gif.</source>
        <translation>Das Zeitfenster, im gewählten Tempo abgespielt, als .mp4 oder .gif.</translation>
    </message>
    <message>
        <source>Mesh</source>
        <translation>Netz</translation>
    </message>
    <message>
        <source>The values at the vertices, as .ply or .glb (glTF).</source>
        <translation>Die Werte an den Eckpunkten, als .ply oder .glb (glTF).</translation>
    </message>
    <message>
        <source>Adds up to</source>
        <translation>Ergibt</translation>
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
        <source>Heatmap</source>
        <translation>Heatmap</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>The forces are unknown.</source>
        <translation>Die Kräfte sind unbekannt.</translation>
    </message>
    <message>
        <source>{low:.1f} to {high:.1f} N</source>
        <translation>{low:.1f} bis {high:.1f} N</translation>
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
        <source>MP4 film (*.mp4);;Animated GIF (*.gif)</source>
        <translation>MP4-Film (*.mp4);;Animiertes GIF (*.gif)</translation>
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
        <source>Drop files here: a recording (.mcap) with its calibration (.json) and the probe (.ply),
contacts (.csv) with the probe, a verification (.json) with the probe,
or the folder of a session, which has them all.</source>
        <translation>Dateien hier ablegen: eine Aufzeichnung (.mcap) mit ihrer Kalibrierung (.json) und der Sonde (.ply),
Kontakte (.csv) mit der Sonde, eine Überprüfung (.json) mit der Sonde,
oder den Ordner einer Sitzung, in dem alles enthalten ist.</translation>
    </message>
    <message>
        <source>Play or pause the time window (P).</source>
        <translation>Das Zeitfenster abspielen oder anhalten (P).</translation>
    </message>
    <message>
        <source>Opening</source>
        <translation>Wird geöffnet</translation>
    </message>
    <message>
        <source>Now give what touched it: a recording, contacts, or a verification.</source>
        <translation>Geben Sie jetzt an, was sie berührt hat: eine Aufzeichnung, Kontakte oder eine Überprüfung.</translation>
    </message>
    <message>
        <source>Reading again</source>
        <translation>Neu lesen</translation>
    </message>
    <message>
        <source>Open the folder of a session</source>
        <translation>Ordner einer Sitzung öffnen</translation>
    </message>
    <message>
        <source>Open recordings, contacts or verifications, with probe and calibration</source>
        <translation>Aufzeichnungen, Kontakte oder Überprüfungen mit Sonde und Kalibrierung öffnen</translation>
    </message>
    <message>
        <source>What can be shown (*.mcap *.csv *.json *.ply *.stl *.obj *.off *.3mf *.glb *.gltf);;All files (*)</source>
        <translation>Was gezeigt werden kann (*.mcap *.csv *.json *.ply *.stl *.obj *.off *.3mf *.glb *.gltf);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Spreading contacts</source>
        <translation>Kontakte werden verteilt</translation>
    </message>
    <message>
        <source>Heatmaps - contactbench</source>
        <translation>Heatmaps - contactbench</translation>
    </message>
</context>
<context>
    <name>Help</name>
    <message>
        <source>There is no help on this page yet.</source>
        <translation>Zu dieser Seite gibt es noch keine Hilfe.</translation>
    </message>
</context>
<context>
    <name>KnownCheckPanel</name>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Reading the check</source>
        <translation>Prüfung lesen</translation>
    </message>
    <message>
        <source>Ending the recording</source>
        <translation>Aufnahme beenden</translation>
    </message>
    <message>
        <source>Beginning to record</source>
        <translation>Aufnahme beginnen</translation>
    </message>
    <message>
        <source>Keeping the recording</source>
        <translation>Aufnahme sichern</translation>
    </message>
    <message>
        <source>Computing the check</source>
        <translation>Prüfung berechnen</translation>
    </message>
    <message>
        <source>Passed</source>
        <translation>Bestanden</translation>
    </message>
    <message>
        <source>Cannot tell</source>
        <translation>Nicht zu entscheiden</translation>
    </message>
    <message>
        <source>Failed</source>
        <translation>Nicht bestanden</translation>
    </message>
    <message>
        <source>Stale: check again</source>
        <translation>Veraltet: bitte neu prüfen</translation>
    </message>
</context>
<context>
    <name>LiveView</name>
    <message>
        <source>The devices of this session could not be opened: {} Choose them anew in step 1.</source>
        <translation>Die Geräte dieser Sitzung konnten nicht geöffnet werden: {} Wählen Sie sie in Schritt 1 neu.</translation>
    </message>
    <message>
        <source>Opening the devices</source>
        <translation>Die Geräte werden geöffnet</translation>
    </message>
    <message>
        <source>no live samples</source>
        <translation>keine laufenden Messwerte</translation>
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
        <source>Closing the session</source>
        <translation>Die Sitzung wird geschlossen</translation>
    </message>
    <message>
        <source>done: {}</source>
        <translation>erledigt: {}</translation>
    </message>
    <message>
        <source>begun</source>
        <translation>begonnen</translation>
    </message>
    <message>
        <source>Remembering the page</source>
        <translation>Die Seite wird gemerkt</translation>
    </message>
    <message>
        <source>Step {} of {}</source>
        <translation>Schritt {} von {}</translation>
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
        <source>Accepted touches, of those that are wanted</source>
        <translation>Gezählte Berührungen, von denen, die gewünscht sind</translation>
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
        <source>No markers yet. Spread some over the probe, click on it, or import a table of measured ones.</source>
        <translation>Noch keine Marker. Verteilen Sie welche auf der Sonde, klicken Sie darauf, oder importieren Sie eine Tabelle mit gemessenen.</translation>
    </message>
    <message>
        <source>Go on: touch them</source>
        <translation>Weiter: berühren</translation>
    </message>
    <message>
        <source>Where markers are placed</source>
        <translation>Wo Marker gesetzt werden</translation>
    </message>
    <message>
        <source>Place them on</source>
        <translation>Setzen auf</translation>
    </message>
    <message>
        <source>How many markers</source>
        <translation>Wie viele Marker</translation>
    </message>
    <message>
        <source>Spread evenly</source>
        <translation>Gleichmäßig verteilen</translation>
    </message>
    <message>
        <source>Distance of the lines of the grid, mm</source>
        <translation>Abstand der Gitterlinien, mm</translation>
    </message>
    <message>
        <source>On a grid</source>
        <translation>Als Gitter</translation>
    </message>
    <message>
        <source>Click on it</source>
        <translation>Anklicken</translation>
    </message>
    <message>
        <source>Every click on the probe adds a marker; with one marker selected, it moves there</source>
        <translation>Jeder Klick auf die Sonde setzt einen Marker; ist ein Marker gewählt, rückt er dorthin</translation>
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
        <translation>Speichern als…</translation>
    </message>
    <message>
        <source>Onto the surface</source>
        <translation>Auf die Oberfläche</translation>
    </message>
    <message>
        <source>Move every marker to the nearest point of the probe</source>
        <translation>Jeden Marker an die nächste Stelle der Sonde setzen</translation>
    </message>
    <message>
        <source>{axis} of a marker in the sensor frame S, mm</source>
        <translation>{axis} eines Markers im Sensorsystem S, mm</translation>
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
        <source>the whole probe</source>
        <translation>die ganze Sonde</translation>
    </message>
    <message>
        <source>Add a marker</source>
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
        <source>Move markers onto the surface</source>
        <translation>Marker auf die Oberfläche setzen</translation>
    </message>
    <message>
        <source>Import markers</source>
        <translation>Marker importieren</translation>
    </message>
    <message>
        <source>Saving the markers</source>
        <translation>Die Marker werden gespeichert</translation>
    </message>
    <message>
        <source>The markers are in {file}.</source>
        <translation>Die Marker sind in {file}.</translation>
    </message>
    <message>
        <source>Tables of markers (*.csv)</source>
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
        <source>Open this session a&amp;gain</source>
        <translation>Diese Sitzung &amp;erneut öffnen</translation>
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
        <source>&amp;View</source>
        <translation>&amp;Ansicht</translation>
    </message>
    <message>
        <source>&amp;Reset layout</source>
        <translation>&amp;Anordnung zurücksetzen</translation>
    </message>
    <message>
        <source>As the &amp;system</source>
        <translation>Wie das &amp;System</translation>
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
        <source>As the &amp;computer</source>
        <translation>Wie der &amp;Computer</translation>
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
        <source>Help</source>
        <translation>Hilfe</translation>
    </message>
    <message>
        <source>The window stood still for at most {:.0f} ms; 99 of 100 times for at most {:.0f} ms.</source>
        <translation>Das Fenster stand höchstens {:.0f} ms still; in 99 von 100 Fällen höchstens {:.0f} ms.</translation>
    </message>
    <message>
        <source>No log is kept.</source>
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
        <source>Diagnostics are saved as {}. They hold no recordings, no meshes and no names.</source>
        <translation>Die Diagnose ist als {} gespeichert. Sie enthält keine Aufzeichnungen, keine Netze und keine Namen.</translation>
    </message>
    <message>
        <source>None yet</source>
        <translation>Noch keine</translation>
    </message>
    <message>
        <source>The language changes when contactbench is started again.</source>
        <translation>Die Sprache wechselt, wenn contactbench neu gestartet wird.</translation>
    </message>
</context>
<context>
    <name>MeshReport</name>
    <message>
        <source>Nothing was found that spoils contacts.</source>
        <translation>Es wurde nichts gefunden, was Kontakte verdirbt.</translation>
    </message>
    <message>
        <source>Fault</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Look at this</source>
        <translation>Ansehen</translation>
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
        <source>Choose a mesh...</source>
        <translation>Netz wählen...</translation>
    </message>
    <message>
        <source>STL, PLY, OBJ, OFF or 3MF; a file can also be dropped on the window</source>
        <translation>STL, PLY, OBJ, OFF oder 3MF; eine Datei kann auch auf das Fenster gezogen werden</translation>
    </message>
    <message>
        <source>Use the virtual bench&apos;s housing</source>
        <translation>Gehäuse des virtuellen Messplatzes nutzen</translation>
    </message>
    <message>
        <source>Drop the mesh of the probe here, as it came from CAD or from a scanner, or choose it.</source>
        <translation>Ziehen Sie das Netz der Sonde hierher, so wie es aus CAD oder vom Scanner kam, oder wählen Sie es.</translation>
    </message>
    <message>
        <source>How long is the probe? The file does not say in which unit it is.</source>
        <translation>Wie lang ist die Sonde? Die Datei sagt nicht, in welcher Einheit sie ist.</translation>
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
        <source>Details of the message</source>
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
        <source>Which messages are shown: all, warnings and errors, or errors only</source>
        <translation>Welche Meldungen gezeigt werden: alle, Warnungen und Fehler, oder nur Fehler</translation>
    </message>
    <message>
        <source>All is well: nothing to report.</source>
        <translation>Alles in Ordnung: nichts zu melden.</translation>
    </message>
    <message>
        <source>Copy the selected messages</source>
        <translation>Gewählte Meldungen kopieren</translation>
    </message>
    <message>
        <source>Which messages are shown</source>
        <translation>Welche Meldungen gezeigt werden</translation>
    </message>
    <message>
        <source>Details</source>
        <translation>Einzelheiten</translation>
    </message>
    <message>
        <source>Show what is behind the selected message</source>
        <translation>Zeigen, was hinter der gewählten Meldung steht</translation>
    </message>
    <message>
        <source>Copy the selected messages with their details</source>
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
        <source>There is nothing more to this message.</source>
        <translation>Mehr gibt es zu dieser Meldung nicht.</translation>
    </message>
    <message>
        <source>Choose a message.</source>
        <translation>Wählen Sie eine Meldung.</translation>
    </message>
</context>
<context>
    <name>MessageRouter</name>
    <message>
        <source>Something went wrong that should not: {}. What is in the session is safe. Try it again; if it comes again, save diagnostics (menu File) and send them to whoever looks after this program.</source>
        <translation>Es ist etwas schiefgegangen, was nicht sein sollte: {}. Was in der Sitzung ist, ist sicher. Versuchen Sie es noch einmal; kommt es wieder, speichern Sie die Diagnose (Menü Datei) und senden Sie sie an die Person, die dieses Programm betreut.</translation>
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
        <source>Both are simulated: nothing real moves.</source>
        <translation>Beide sind simuliert: Nichts Wirkliches bewegt sich.</translation>
    </message>
    <message>
        <source>tilts along the face</source>
        <translation>kippt längs der Fläche</translation>
    </message>
    <message>
        <source>tilts across the face</source>
        <translation>kippt quer zur Fläche</translation>
    </message>
    <message>
        <source>goes up and down</source>
        <translation>geht auf und ab</translation>
    </message>
    <message>
        <source>rests</source>
        <translation>ruht</translation>
    </message>
    <message>
        <source>The phantom</source>
        <translation>Das Phantom</translation>
    </message>
    <message>
        <source>How the soft phantom moves under the probe.</source>
        <translation>Wie sich das weiche Phantom unter der Sonde bewegt.</translation>
    </message>
    <message>
        <source>{seconds:g} s</source>
        <translation>{seconds:g} s</translation>
    </message>
    <message>
        <source>There and back in</source>
        <translation>Hin und zurück in</translation>
    </message>
    <message>
        <source>Period T of the phantom&apos;s motion.</source>
        <translation>Periode T der Bewegung des Phantoms.</translation>
    </message>
    <message>
        <source>as in the bundle</source>
        <translation>wie im Paket</translation>
    </message>
    <message>
        <source>aware</source>
        <translation>vorausschauend</translation>
    </message>
    <message>
        <source>plain</source>
        <translation>einfach</translation>
    </message>
    <message>
        <source>Control</source>
        <translation>Regelung</translation>
    </message>
    <message>
        <source>Aware: how the phantom moves is estimated and led. Plain: force and place alone.</source>
        <translation>Vorausschauend: Die Bewegung des Phantoms wird geschätzt und vorweggenommen. Einfach: nur Kraft und Ort.</translation>
    </message>
    <message>
        <source>Amplitude of the phantom&apos;s motion, to either side.</source>
        <translation>Ausschlag des Phantoms, nach jeder Seite.</translation>
    </message>
    <message>
        <source>How far</source>
        <translation>Wie weit</translation>
    </message>
    <message>
        <source>What the controller does</source>
        <translation>Was die Regelung tut</translation>
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
        <source>What would be exported of the open session now.</source>
        <translation>Was aus der offenen Sitzung jetzt exportiert würde.</translation>
    </message>
    <message>
        <source>This session</source>
        <translation>Diese Sitzung</translation>
    </message>
    <message>
        <source>A folder or zip file that was exported.</source>
        <translation>Ein Ordner oder eine Zip-Datei, die exportiert wurde.</translation>
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
        <source>The probe goes back and stands still (Esc).</source>
        <translation>Die Sonde geht zurück und steht still (Esc).</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Stopp</translation>
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
        <source>Not running</source>
        <translation>Läuft nicht</translation>
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
        <source>{time:.1f} s  {state}: {why}</source>
        <translation>{time:.1f} s  {state}: {why}</translation>
    </message>
    <message>
        <source>Approaching</source>
        <translation>Nähert sich</translation>
    </message>
    <message>
        <source>The probe goes slowly towards the phantom.</source>
        <translation>Die Sonde geht langsam auf das Phantom zu.</translation>
    </message>
    <message>
        <source>In contact</source>
        <translation>In Kontakt</translation>
    </message>
    <message>
        <source>The force grows; then the stiffness is felt.</source>
        <translation>Die Kraft wächst; dann wird die Steifigkeit ertastet.</translation>
    </message>
    <message>
        <source>Tracking</source>
        <translation>Folgt</translation>
    </message>
    <message>
        <source>It keeps its force and stands upright.</source>
        <translation>Sie hält ihre Kraft und steht senkrecht.</translation>
    </message>
    <message>
        <source>Holding</source>
        <translation>Hält an</translation>
    </message>
    <message>
        <source>Nothing moves until it is sure again.</source>
        <translation>Nichts bewegt sich, bis alles wieder sicher ist.</translation>
    </message>
    <message>
        <source>Going back</source>
        <translation>Geht zurück</translation>
    </message>
    <message>
        <source>The probe leaves the phantom.</source>
        <translation>Die Sonde verlässt das Phantom.</translation>
    </message>
    <message>
        <source>Standing still</source>
        <translation>Steht still</translation>
    </message>
    <message>
        <source>It has ended; nothing moves any more.</source>
        <translation>Es ist zu Ende; nichts bewegt sich mehr.</translation>
    </message>
</context>
<context>
    <name>MotionWindow</name>
    <message>
        <source>Choose a bundle; then press Start. All is simulated: nothing real moves.</source>
        <translation>Wählen Sie ein Paket und drücken Sie Starten. Alles ist simuliert: Nichts Wirkliches bewegt sich.</translation>
    </message>
    <message>
        <source>No session is open: open one, or choose a bundle.</source>
        <translation>Keine Sitzung ist offen: Öffnen Sie eine, oder wählen Sie ein Paket.</translation>
    </message>
    <message>
        <source>Making the session&apos;s bundle…</source>
        <translation>Das Paket der Sitzung wird gemacht…</translation>
    </message>
    <message>
        <source>Making a bundle</source>
        <translation>Ein Paket wird gemacht</translation>
    </message>
    <message>
        <source>Opening the bundle…</source>
        <translation>Das Paket wird geöffnet…</translation>
    </message>
    <message>
        <source>Opening a bundle</source>
        <translation>Ein Paket wird geöffnet</translation>
    </message>
    <message>
        <source>{name}: {facets:,} facets.</source>
        <translation>{name}: {facets:,} Facetten.</translation>
    </message>
    <message>
        <source>It is not verified: for trials only.</source>
        <translation>Es ist nicht überprüft: nur für Versuche.</translation>
    </message>
    <message>
        <source>How the sensor is mounted is not said: it is taken as not turned.</source>
        <translation>Wie der Sensor sitzt, ist nicht gesagt: Er gilt als nicht gedreht.</translation>
    </message>
    <message>
        <source>It has no gains: the usual ones for its probe are taken.</source>
        <translation>Es hat keine Verstärkungen: Die üblichen für seine Sonde werden genommen.</translation>
    </message>
    <message>
        <source>It presses with {force:g} N.</source>
        <translation>Es drückt mit {force:g} N.</translation>
    </message>
    <message>
        <source>Open a bundle</source>
        <translation>Ein Paket öffnen</translation>
    </message>
    <message>
        <source>Bundles (*.zip contactbench.json);;All files (*)</source>
        <translation>Pakete (*.zip contactbench.json);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>The virtual robot is being made…</source>
        <translation>Der virtuelle Roboter wird gemacht…</translation>
    </message>
    <message>
        <source>This computer is too slow for real time: what is seen goes {pace:.1f} times as fast.</source>
        <translation>Dieser Rechner ist zu langsam für Echtzeit: Was zu sehen ist, geht {pace:.1f}-mal so schnell.</translation>
    </message>
    <message>
        <source>It tracked for {seconds:.0f} s with {low:.1f} to {high:.1f} N, on average {within:.1f}° off along the face and {out:.1f}° across it.</source>
        <translation>Sie folgte {seconds:.0f} s lang mit {low:.1f} bis {high:.1f} N, im Mittel {within:.1f}° daneben längs der Fläche und {out:.1f}° quer dazu.</translation>
    </message>
</context>
<context>
    <name>NextBar</name>
    <message>
        <source>How far the work is</source>
        <translation>Wie weit die Arbeit ist</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
</context>
<context>
    <name>Pages</name>
    <message>
        <source>Looking at the session</source>
        <translation>Die Sitzung wird angesehen</translation>
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
        <source>wanted</source>
        <translation>gewollt</translation>
    </message>
    <message>
        <source>angle along the face</source>
        <translation>Winkel längs der Fläche</translation>
    </message>
    <message>
        <source>across it</source>
        <translation>quer dazu</translation>
    </message>
    <message>
        <source>Angle to the phantom</source>
        <translation>Winkel zum Phantom</translation>
    </message>
</context>
<context>
    <name>PlaceSection</name>
    <message>
        <source>3  Place on the sensor</source>
        <translation>3  Lage auf dem Sensor</translation>
    </message>
    <message>
        <source>Placing the mesh</source>
        <translation>Das Netz wird platziert</translation>
    </message>
</context>
<context>
    <name>PointPanel</name>
    <message>
        <source>Known point</source>
        <translation>Bekannter Punkt</translation>
    </message>
    <message>
        <source>Press one marker on the side of the probe with a finger. It shows a wrong sign or unit of the torques, and a probe that is turned on the sensor.</source>
        <translation>Mit dem Finger auf einen Marker an der Seite der Sonde drücken. Das zeigt ein falsches Vorzeichen oder eine falsche Einheit der Drehmomente und eine Sonde, die auf dem Sensor verdreht ist.</translation>
    </message>
    <message>
        <source>Marker</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>Record a press</source>
        <translation>Druck aufnehmen</translation>
    </message>
    <message>
        <source>Place a marker first, on the tab Markers.</source>
        <translation>Zuerst unter Marker einen Marker setzen.</translation>
    </message>
</context>
<context>
    <name>PointTable</name>
    <message>
        <source>on the mesh</source>
        <translation>auf dem Netz</translation>
    </message>
    <message>
        <source>Matching points: on the mesh, and in the sensor frame, in mm</source>
        <translation>Punktpaare: auf dem Netz und im Sensorsystem, in mm</translation>
    </message>
    <message>
        <source>Type where each place lies in the sensor frame, in mm</source>
        <translation>Geben Sie ein, wo jede Stelle im Sensorsystem liegt, in mm</translation>
    </message>
    <message>
        <source>Remove this place</source>
        <translation>Diese Stelle entfernen</translation>
    </message>
</context>
<context>
    <name>PoseModel</name>
    <message>
        <source>pose</source>
        <translation>Pose</translation>
    </message>
    <message>
        <source>tilt</source>
        <translation>Neigung</translation>
    </message>
    <message>
        <source>residual</source>
        <translation>Abw. (σ)</translation>
    </message>
    <message>
        <source>state</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>How far the reading is from what all poses together predict, in standard deviations: 1 is usual, above 3 is worth a look.</source>
        <translation>Restabweichung: wie weit der Messwert von dem entfernt ist, was alle Posen zusammen vorhersagen, in Standardabweichungen. 1 ist üblich, über 3 lohnt ein Blick.</translation>
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
        <source>taken</source>
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
        <source>Address of the robot</source>
        <translation>Adresse des Roboters</translation>
    </message>
    <message>
        <source>File of poses</source>
        <translation>Datei mit Posen</translation>
    </message>
    <message>
        <source>Poses (*.csv);;All files (*)</source>
        <translation>Posen (*.csv);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Turn of the flange about {axis}</source>
        <translation>Drehung des Flanschs um {axis}</translation>
    </message>
    <message>
        <source>From the sensor&apos;s own source</source>
        <translation>Aus der Quelle des Sensors selbst</translation>
    </message>
    <message>
        <source>Robot</source>
        <translation>Roboter</translation>
    </message>
    <message>
        <source>Does not move</source>
        <translation>Bewegt sich nicht</translation>
    </message>
    <message>
        <source>Nothing tells it</source>
        <translation>Nichts gibt sie an</translation>
    </message>
    <message>
        <source>A virtual bench and most recordings also give the orientation.</source>
        <translation>Ein virtueller Messplatz und die meisten Aufzeichnungen liefern auch die Orientierung.</translation>
    </message>
    <message>
        <source>Without it gravity cannot be calibrated: only raw readings can be seen.</source>
        <translation>Ohne sie kann die Schwerkraft nicht kalibriert werden: Nur rohe Messwerte sind zu sehen.</translation>
    </message>
    <message>
        <source>This sensor does not tell its orientation: choose the robot that moves it.</source>
        <translation>Dieser Sensor gibt seine Orientierung nicht an: Wählen Sie den Roboter, der ihn bewegt.</translation>
    </message>
    <message>
        <source>Choose a file of poses.</source>
        <translation>Wählen Sie eine Datei mit Posen.</translation>
    </message>
</context>
<context>
    <name>ProbePage</name>
    <message>
        <source>Mesh of the probe</source>
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
        <source>Keeping the probe</source>
        <translation>Die Sonde wird behalten</translation>
    </message>
    <message>
        <source>In use. Go on: Regions</source>
        <translation>In Gebrauch. Weiter: Regionen</translation>
    </message>
    <message>
        <source>Choose a mesh...</source>
        <translation>Netz wählen...</translation>
    </message>
    <message>
        <source>Say how long the probe is (1)</source>
        <translation>Länge der Sonde angeben (1)</translation>
    </message>
    <message>
        <source>Make the outer surface</source>
        <translation>Außenfläche machen</translation>
    </message>
    <message>
        <source>Say where it lies (3)</source>
        <translation>Angeben, wo sie liegt (3)</translation>
    </message>
    <message>
        <source>Prepare the probe</source>
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
        <source>The session&apos;s probe.</source>
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
        <source>Reading {}</source>
        <translation>{} wird gelesen</translation>
    </message>
    <message>
        <source>Making the housing of the virtual bench</source>
        <translation>Das Gehäuse des virtuellen Messplatzes wird gemacht</translation>
    </message>
    <message>
        <source>Looking at the mesh in its unit</source>
        <translation>Das Netz wird in seiner Einheit angesehen</translation>
    </message>
    <message>
        <source>Making the outer surface</source>
        <translation>Die Außenfläche wird gemacht</translation>
    </message>
    <message>
        <source>Placing the mesh</source>
        <translation>Das Netz wird platziert</translation>
    </message>
    <message>
        <source>Comparing numbers of facets</source>
        <translation>Anzahlen von Facetten werden verglichen</translation>
    </message>
    <message>
        <source>Preparing the probe</source>
        <translation>Die Sonde wird vorbereitet</translation>
    </message>
    <message>
        <source>use the probe</source>
        <translation>die Sonde nutzen</translation>
    </message>
    <message>
        <source>The probe of {:,} facets is in use. Next: regions, or verify.</source>
        <translation>Die Sonde mit {:,} Facetten ist in Gebrauch. Als Nächstes: Regionen oder Prüfen.</translation>
    </message>
    <message>
        <source>Opening the probe</source>
        <translation>Die Sonde wird geöffnet</translation>
    </message>
</context>
<context>
    <name>ProbeWorker</name>
    <message>
        <source>Stopping...</source>
        <translation>Wird angehalten...</translation>
    </message>
    <message>
        <source>Stopped. Nothing was changed.</source>
        <translation>Angehalten. Nichts wurde geändert.</translation>
    </message>
    <message>
        <source>Something unexpected went wrong ({}). What there was is as it was; try again.</source>
        <translation>Unerwartet ist etwas schiefgegangen ({}). Alles ist, wie es war; versuchen Sie es noch einmal.</translation>
    </message>
</context>
<context>
    <name>ProgressStrip</name>
    <message>
        <source>How far the work is</source>
        <translation>Wie weit die Arbeit ist</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Stop this work; nothing that is done is lost</source>
        <translation>Diese Arbeit anhalten; nichts Fertiges geht verloren</translation>
    </message>
    <message>
        <source> (and {} more)</source>
        <translation> (und {} weitere)</translation>
    </message>
    <message>
        <source>Stopping</source>
        <translation>Wird angehalten</translation>
    </message>
</context>
<context>
    <name>ReadOnlyView</name>
    <message>
        <source>Read-only</source>
        <translation>Schreibgeschützt</translation>
    </message>
    <message>
        <source>Read-only: this session is damaged. To go on working, close it, open it again and salvage a copy.</source>
        <translation>Schreibgeschützt: Diese Sitzung ist beschädigt. Um weiterzuarbeiten, schließen Sie sie, öffnen Sie sie erneut und retten Sie eine Kopie.</translation>
    </message>
    <message>
        <source>Read-only: another program is writing this session. It is shown as it was when it was opened.</source>
        <translation>Schreibgeschützt: Ein anderes Programm schreibt in diese Sitzung. Sie wird so gezeigt, wie sie beim Öffnen war.</translation>
    </message>
    <message>
        <source>Read-only: the folder of this session cannot be written. To go on working, make it writable or copy it.</source>
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
        <source>Mount of the sensor, degrees</source>
        <translation>Montage des Sensors, Grad</translation>
    </message>
    <message>
        <source>Off: as the session says, or not turned. On: about the flange&apos;s fixed axes x, y, z.</source>
        <translation>Aus: wie die Sitzung sagt, sonst nicht gedreht. Ein: um die festen Achsen x, y, z des Flansches.</translation>
    </message>
    <message>
        <source>Mount about {axis}, degrees</source>
        <translation>Montage um {axis}, Grad</translation>
    </message>
    <message>
        <source>How much later a wrench is heard than its pose, ms</source>
        <translation>Um wie viel später ein Messwert ankommt als seine Pose, ms</translation>
    </message>
    <message>
        <source>A touch is above this force, N</source>
        <translation>Eine Berührung liegt über dieser Kraft, N</translation>
    </message>
    <message>
        <source>Delay</source>
        <translation>Verzug</translation>
    </message>
    <message>
        <source>Touched above</source>
        <translation>Berührt ab</translation>
    </message>
</context>
<context>
    <name>RegionAutosave</name>
    <message>
        <source>Keeping the regions</source>
        <translation>Die Regionen werden behalten</translation>
    </message>
</context>
<context>
    <name>RegionBrush</name>
    <message>
        <source>No region is chosen: add one, or choose one in the list, then paint.</source>
        <translation>Keine Region ist gewählt: Fügen Sie eine hinzu, oder wählen Sie eine in der Liste, dann malen Sie.</translation>
    </message>
</context>
<context>
    <name>RegionListWidget</name>
    <message>
        <source>Regions, the first priority first</source>
        <translation>Regionen, die wichtigste zuerst</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Add a region with the last priority</source>
        <translation>Eine Region mit der letzten Priorität hinzufügen</translation>
    </message>
    <message>
        <source>Colour</source>
        <translation>Farbe</translation>
    </message>
    <message>
        <source>Choose the colour</source>
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
        <source>Remove the region; its facets belong to none then</source>
        <translation>Die Region entfernen; ihre Facetten gehören dann zu keiner</translation>
    </message>
    <message>
        <source>Raise the region&apos;s priority</source>
        <translation>Priorität der Region erhöhen</translation>
    </message>
    <message>
        <source>Lower the region&apos;s priority</source>
        <translation>Priorität der Region senken</translation>
    </message>
    <message>
        <source>Untouchable</source>
        <translation>Nicht berührbar</translation>
    </message>
    <message>
        <source>Nothing can touch these facets: a clamp or a drape hides them. Contacts there count as 1000 times less likely.</source>
        <translation>Nichts kann diese Facetten berühren: Eine Klemme oder ein Tuch verdeckt sie. Kontakte dort gelten als 1000-mal weniger wahrscheinlich.</translation>
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
        <source>Double-click to rename; drag, or Alt+Up and Alt+Down, to change the priority.</source>
        <translation>Doppelklick zum Umbenennen; Ziehen, oder Alt+Hoch und Alt+Herunter, ändert die Priorität.</translation>
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
        <source>Take the stroke back, or look only</source>
        <translation>Strich zurücknehmen, oder nur ansehen</translation>
    </message>
    <message>
        <source>There is no probe yet. Regions are painted on it: prepare it first.</source>
        <translation>Es gibt noch keine Sonde. Regionen werden auf ihr gemalt: Bereiten Sie sie zuerst vor.</translation>
    </message>
    <message>
        <source>It was cancelled.</source>
        <translation>Es wurde abgebrochen.</translation>
    </message>
    <message>
        <source>Making the surface to paint on</source>
        <translation>Die Fläche zum Bemalen wird gemacht</translation>
    </message>
    <message>
        <source>Facets: {0:,}; area: {1:.2f} cm²</source>
        <translation>Facetten: {0:,}; Fläche: {1:.2f} cm²</translation>
    </message>
    <message>
        <source>Finding the facets</source>
        <translation>Die Facetten werden gesucht</translation>
    </message>
    <message>
        <source>Nothing changed: the region is like that already.</source>
        <translation>Nichts geändert: Die Region ist schon so.</translation>
    </message>
    <message>
        <source>give the probe its regions</source>
        <translation>der Sonde ihre Regionen geben</translation>
    </message>
    <message>
        <source>The probe has its regions now.</source>
        <translation>Die Sonde hat jetzt ihre Regionen.</translation>
    </message>
    <message>
        <source>Giving the probe its regions</source>
        <translation>Die Sonde bekommt ihre Regionen</translation>
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
        <source>The regions are written to {0}.</source>
        <translation>Die Regionen sind in {0} geschrieben.</translation>
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
        <source>Mark the parts that are meant to be touched, the most important first: where a reading fits several places, the contact is looked for there. Regions are optional.</source>
        <translation>Markieren Sie die Teile, die berührt werden sollen, die wichtigsten zuerst: Passt ein Messwert zu mehreren Stellen, wird der Kontakt dort gesucht. Regionen sind freiwillig.</translation>
    </message>
    <message>
        <source>How far it is</source>
        <translation>Wie weit es ist</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Go to Probe</source>
        <translation>Zur Sonde</translation>
    </message>
    <message>
        <source>Give them to the probe</source>
        <translation>Der Sonde geben</translation>
    </message>
    <message>
        <source>Computes the probe again, with more facets in the regions</source>
        <translation>Berechnet die Sonde neu, mit mehr Facetten in den Regionen</translation>
    </message>
    <message>
        <source>Import...</source>
        <translation>Importieren...</translation>
    </message>
    <message>
        <source>Replace all regions by those of a JSON or CSV file</source>
        <translation>Alle Regionen durch die einer JSON- oder CSV-Datei ersetzen</translation>
    </message>
    <message>
        <source>Export...</source>
        <translation>Exportieren...</translation>
    </message>
    <message>
        <source>Write the regions to a JSON or CSV file</source>
        <translation>Die Regionen in eine JSON- oder CSV-Datei schreiben</translation>
    </message>
    <message>
        <source>Go on to Verify</source>
        <translation>Weiter zu Prüfen</translation>
    </message>
    <message>
        <source>Go on without regions</source>
        <translation>Weiter ohne Regionen</translation>
    </message>
    <message>
        <source>The surface to paint on is being made.</source>
        <translation>Die Fläche zum Bemalen wird gemacht.</translation>
    </message>
    <message>
        <source>Computing.</source>
        <translation>Wird berechnet.</translation>
    </message>
    <message>
        <source>The regions are not kept in the session: {0} The next change tries again.</source>
        <translation>Die Regionen sind nicht in der Sitzung behalten: {0} Die nächste Änderung versucht es wieder.</translation>
    </message>
    <message>
        <source>There are no regions yet: add one, then paint it on the probe.</source>
        <translation>Es gibt noch keine Regionen: Fügen Sie eine hinzu und malen Sie sie auf die Sonde.</translation>
    </message>
    <message>
        <source>Choose a region in the list, then paint it on the probe.</source>
        <translation>Wählen Sie eine Region in der Liste und malen Sie sie auf die Sonde.</translation>
    </message>
    <message>
        <source>Nothing is painted yet: take the brush and drag over the probe.</source>
        <translation>Noch ist nichts gemalt: Nehmen Sie den Pinsel und ziehen Sie über die Sonde.</translation>
    </message>
    <message>
        <source>Painted; it is kept in the session in a moment.</source>
        <translation>Gemalt; gleich ist es in der Sitzung behalten.</translation>
    </message>
    <message>
        <source>The probe has these regions.</source>
        <translation>Die Sonde hat diese Regionen.</translation>
    </message>
    <message>
        <source>Kept in the session. The probe takes them along when it is made.</source>
        <translation>In der Sitzung behalten. Die Sonde nimmt sie mit, wenn sie gemacht wird.</translation>
    </message>
    <message>
        <source>Kept in the session, but the probe does not have them yet.</source>
        <translation>In der Sitzung behalten, aber die Sonde hat sie noch nicht.</translation>
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
        <source>Take back</source>
        <translation>Zurücknehmen</translation>
    </message>
</context>
<context>
    <name>ResultPanel</name>
    <message>
        <source>Open the report</source>
        <translation>Bericht öffnen</translation>
    </message>
    <message>
        <source>Verify again</source>
        <translation>Erneut prüfen</translation>
    </message>
    <message>
        <source>Go on: Export</source>
        <translation>Weiter: Export</translation>
    </message>
    <message>
        <source>Not verified yet</source>
        <translation>Noch nicht geprüft</translation>
    </message>
    <message>
        <source>Stale: verify again</source>
        <translation>Veraltet: erneut prüfen</translation>
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
        <source>no touch counted</source>
        <translation>keine Berührung zählte</translation>
    </message>
    <message>
        <source>{mean} mm</source>
        <translation>{mean} mm</translation>
    </message>
    <message>
        <source>mean error of one touch</source>
        <translation>Fehler einer einzigen Berührung</translation>
    </message>
    <message>
        <source>mean error of {count} touches</source>
        <translation>mittlerer Fehler von {count} Berührungen</translation>
    </message>
    <message>
        <source>mean error of {count} touches; surely between {low} and {high} mm (95 %)</source>
        <translation>mittlerer Fehler von {count} Berührungen; sicher zwischen {low} und {high} mm (95 %)</translation>
    </message>
    <message>
        <source>Largest error: {size} mm; up to {limit} mm passes</source>
        <translation>Größter Fehler: {size} mm; bis {limit} mm ist bestanden</translation>
    </message>
    <message>
        <source>Mean error: up to {limit} mm passes</source>
        <translation>Mittlerer Fehler: bis {limit} mm ist bestanden</translation>
    </message>
    <message>
        <source>95 % of touches: within {size} mm</source>
        <translation>95 % der Berührungen: innerhalb von {size} mm</translation>
    </message>
    <message>
        <source>{ratio} times what noise and calibration explain</source>
        <translation>das {ratio}-Fache dessen, was Rauschen und Kalibrierung erklären</translation>
    </message>
    <message>
        <source>Not counted: {listed}.</source>
        <translation>Nicht gezählt: {listed}.</translation>
    </message>
</context>
<context>
    <name>ScaleBar</name>
    <message>
        <source>Scale: the bar is {length} long</source>
        <translation>Maßstab: Der Balken ist {length} lang</translation>
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
</context>
<context>
    <name>SensorSource</name>
    <message>
        <source>Force/torque sensor</source>
        <translation>Kraft-Momenten-Sensor</translation>
    </message>
    <message>
        <source>It is a sensor of {maker}</source>
        <translation>Es ist ein Sensor von {maker}</translation>
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
        <source>Maker of the sensor</source>
        <translation>Hersteller des Sensors</translation>
    </message>
    <message>
        <source>Probe of the virtual bench</source>
        <translation>Sonde des virtuellen Messplatzes</translation>
    </message>
    <message>
        <source>Address of the sensor</source>
        <translation>Adresse des Sensors</translation>
    </message>
    <message>
        <source>sri+serial, sri+tcp, bota+serial, robotiq+serial or rdt+udp, ://, and where it is</source>
        <translation>sri+serial, sri+tcp, bota+serial, robotiq+serial oder rdt+udp, ://, und wo er ist</translation>
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
        <source>Address typed in</source>
        <translation>Eingegebene Adresse</translation>
    </message>
    <message>
        <source>{guess} sensor at {path}</source>
        <translation>{guess}-Sensor an {path}</translation>
    </message>
</context>
<context>
    <name>SessionProbe</name>
    <message>
        <source>Reading the probe</source>
        <translation>Die Sonde wird gelesen</translation>
    </message>
</context>
<context>
    <name>Sessions</name>
    <message>
        <source>Looking for recent sessions</source>
        <translation>Zuletzt benutzte Sitzungen werden gesucht</translation>
    </message>
    <message>
        <source>Preparing the virtual bench</source>
        <translation>Der virtuelle Messplatz wird vorbereitet</translation>
    </message>
    <message>
        <source>Opening {}</source>
        <translation>{} wird geöffnet</translation>
    </message>
    <message>
        <source>Making {}</source>
        <translation>{} wird angelegt</translation>
    </message>
    <message>
        <source>Make a session in a new or empty folder</source>
        <translation>Sitzung in einem neuen oder leeren Ordner anlegen</translation>
    </message>
    <message>
        <source>Make session</source>
        <translation>Sitzung anlegen</translation>
    </message>
    <message>
        <source>Open the folder of a session</source>
        <translation>Ordner einer Sitzung öffnen</translation>
    </message>
    <message>
        <source>The last work on {} ended abruptly, while a recording was being made. Everything up to half a second before the end is there. Take the recording into the session?</source>
        <translation>Die letzte Arbeit an {} endete plötzlich, während eine Aufzeichnung lief. Alles bis eine halbe Sekunde vor dem Ende ist da. Die Aufzeichnung in die Sitzung übernehmen?</translation>
    </message>
    <message>
        <source>The last work on {} ended abruptly, while {} recordings were being made. Everything up to half a second before the end is there. Take the recordings into the session?</source>
        <translation>Die letzte Arbeit an {} endete plötzlich, während {} Aufzeichnungen liefen. Alles bis eine halbe Sekunde vor dem Ende ist da. Die Aufzeichnungen in die Sitzung übernehmen?</translation>
    </message>
    <message>
        <source>Take them in</source>
        <translation>Übernehmen</translation>
    </message>
    <message>
        <source>Take it in</source>
        <translation>Übernehmen</translation>
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
        <source>Taking the recordings in</source>
        <translation>Die Aufzeichnungen werden übernommen</translation>
    </message>
    <message>
        <source>The session could not be opened: {}</source>
        <translation>Die Sitzung konnte nicht geöffnet werden: {}</translation>
    </message>
    <message>
        <source>Salvaging a copy of {}</source>
        <translation>Eine Kopie von {} wird gerettet</translation>
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
        <translation>Noch einmal versuchen</translation>
    </message>
</context>
<context>
    <name>ShapePanel</name>
    <message>
        <source>The chosen region</source>
        <translation>Die gewählte Region</translation>
    </message>
    <message>
        <source>Mirror the chosen region</source>
        <translation>Gewählte Region spiegeln</translation>
    </message>
    <message>
        <source>Mirror</source>
        <translation>Spiegeln</translation>
    </message>
    <message>
        <source>Also take what lies on the other side of the plane (M)</source>
        <translation>Auch nehmen, was auf der anderen Seite der Ebene liegt (M)</translation>
    </message>
    <message>
        <source>Plane to mirror at</source>
        <translation>Ebene, an der gespiegelt wird</translation>
    </message>
    <message>
        <source>at {0} =</source>
        <translation>bei {0} =</translation>
    </message>
    <message>
        <source>Where the mirror plane is, mm in the sensor frame S</source>
        <translation>Wo die Spiegelebene liegt, mm im Sensorsystem S</translation>
    </message>
    <message>
        <source>How far to grow or shrink, mm along the surface</source>
        <translation>Wie weit vergrößert oder verkleinert wird, mm entlang der Oberfläche</translation>
    </message>
    <message>
        <source>Rings: </source>
        <translation>Ringe: </translation>
    </message>
    <message>
        <source>How many rings of facets to smooth over</source>
        <translation>Über wie viele Ringe von Facetten geglättet wird</translation>
    </message>
    <message>
        <source>What is narrower than about this many facets goes</source>
        <translation>Was schmaler als etwa so viele Facetten ist, verschwindet</translation>
    </message>
    <message>
        <source>Grow</source>
        <translation>Größer</translation>
    </message>
    <message>
        <source>Move the border outwards; other regions stay</source>
        <translation>Den Rand nach außen schieben; andere Regionen bleiben</translation>
    </message>
    <message>
        <source>Shrink</source>
        <translation>Kleiner</translation>
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
        <source>Take all facets out of the region</source>
        <translation>Alle Facetten aus der Region nehmen</translation>
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
        <source>How the contact error shrank</source>
        <translation>Wie der Kontaktfehler kleiner wurde</translation>
    </message>
</context>
<context>
    <name>Side</name>
    <message>
        <source>What is shown</source>
        <translation>Was gezeigt wird</translation>
    </message>
    <message>
        <source>Value under the cursor</source>
        <translation>Wert unter dem Zeiger</translation>
    </message>
    <message>
        <source>± 1 sigma. Density: by the number of touches behind it.
Means: the spread of what they are the mean of. Peak force: the sensor&apos;s noise.</source>
        <translation>± 1 Sigma. Dichte: nach der Zahl der Berührungen dahinter.
Mittelwerte: Streuung dessen, wovon sie das Mittel sind. Größte Kraft: Rauschen des Sensors.</translation>
    </message>
    <message>
        <source>Nothing to show: {why}</source>
        <translation>Nichts zu zeigen: {why}</translation>
    </message>
    <message>
        <source>No contact in this time window and range of force: widen one of them.</source>
        <translation>Kein Kontakt in diesem Zeitfenster und Kraftbereich: Erweitern Sie eines davon.</translation>
    </message>
    <message>
        <source>Touches: {count:,} of {all:,}; plain grey: no data</source>
        <translation>Berührungen: {count:,} von {all:,}; einfaches Grau: keine Daten</translation>
    </message>
    <message>
        <source>Samples: {count:,} of {all:,}; plain grey: no data</source>
        <translation>Messwerte: {count:,} von {all:,}; einfaches Grau: keine Daten</translation>
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
        <source>Calibrate a force/torque sensor behind a probe, prepare the probe&apos;s mesh, verify contacts at the bench, and export a bundle.</source>
        <translation>Kalibrieren Sie einen Kraft-Momenten-Sensor hinter einer Sonde, bereiten Sie das Netz der Sonde vor, prüfen Sie Kontakte am Messplatz, und exportieren Sie ein Paket.</translation>
    </message>
    <message>
        <source>Recent sessions</source>
        <translation>Zuletzt benutzte Sitzungen</translation>
    </message>
    <message>
        <source>A session&apos;s folder can also be dropped on this window.</source>
        <translation>Der Ordner einer Sitzung kann auch auf dieses Fenster gezogen werden.</translation>
    </message>
    <message>
        <source>Try the virtual bench</source>
        <translation>Virtuellen Messplatz ausprobieren</translation>
    </message>
    <message>
        <source>A simulated sensor, robot and probe: nothing needs to be connected</source>
        <translation>Simulierter Sensor, Roboter und Sonde: Nichts muss angeschlossen sein</translation>
    </message>
    <message>
        <source>New session</source>
        <translation>Neue Sitzung</translation>
    </message>
    <message>
        <source>Begin with an empty folder for one sensor and one probe</source>
        <translation>Mit einem leeren Ordner für einen Sensor und eine Sonde beginnen</translation>
    </message>
    <message>
        <source>Open session</source>
        <translation>Sitzung öffnen</translation>
    </message>
    <message>
        <source>Go on with a session that is on this computer</source>
        <translation>Mit einer Sitzung weitermachen, die auf diesem Computer ist</translation>
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
        <source>Size of the force</source>
        <translation>Betrag der Kraft</translation>
    </message>
    <message>
        <source>Contact point</source>
        <translation>Kontaktpunkt</translation>
    </message>
    <message>
        <source>Nothing is measured yet: choose the devices.</source>
        <translation>Noch wird nichts gemessen: Wählen Sie die Geräte.</translation>
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
        <source>Which wrenches the charts show</source>
        <translation>Welche Kräfte und Momente die Diagramme zeigen</translation>
    </message>
    <message>
        <source>Raw: as the sensor gives them. Compensated: without bias and weight.</source>
        <translation>Roh: wie der Sensor sie liefert. Kompensiert: ohne Nullpunktfehler und Gewicht.</translation>
    </message>
    <message>
        <source>{seconds:g} s</source>
        <translation>{seconds:g} s</translation>
    </message>
    <message>
        <source>How much time the charts show</source>
        <translation>Wie viel Zeit die Diagramme zeigen</translation>
    </message>
    <message>
        <source>How much time is shown, in seconds</source>
        <translation>Wie viel Zeit gezeigt wird, in Sekunden</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>Hold the picture; recording goes on</source>
        <translation>Das Bild festhalten; die Aufzeichnung geht weiter</translation>
    </message>
    <message>
        <source>Back to live</source>
        <translation>Zurück zu jetzt</translation>
    </message>
    <message>
        <source>Show what is measured now</source>
        <translation>Zeigen, was jetzt gemessen wird</translation>
    </message>
    <message>
        <source>Panes</source>
        <translation>Felder</translation>
    </message>
    <message>
        <source>Choose which charts are shown</source>
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
        <source>as it seems best</source>
        <translation>automatisch</translation>
    </message>
    <message>
        <source>by a fair surface</source>
        <translation>mit glatter Fläche</translation>
    </message>
    <message>
        <source>by straight lines</source>
        <translation>mit geraden Linien</translation>
    </message>
    <message>
        <source>by the hull of the rim</source>
        <translation>mit der Hülle des Rands</translation>
    </message>
    <message>
        <source>leave them open</source>
        <translation>offen lassen</translation>
    </message>
    <message>
        <source>How openings are closed, such as the one for the cable</source>
        <translation>Wie Öffnungen geschlossen werden, etwa die für das Kabel</translation>
    </message>
    <message>
        <source>Close openings</source>
        <translation>Öffnungen schließen</translation>
    </message>
    <message>
        <source>by the size</source>
        <translation>nach der Größe</translation>
    </message>
    <message>
        <source>Size of the outer surface&apos;s facets, mm; 0: a 190th of the probe&apos;s length</source>
        <translation>Größe der Facetten der Außenfläche, mm; 0: ein 190stel der Länge der Sonde</translation>
    </message>
    <message>
        <source>Facet size</source>
        <translation>Facettengröße</translation>
    </message>
</context>
<context>
    <name>TimeBar</name>
    <message>
        <source>Time window</source>
        <translation>Zeitfenster</translation>
    </message>
    <message>
        <source>Time in seconds. Drag the handles, or what is between them; above the line, the moment shown.
Keys: left and right, Space for the other handle.</source>
        <translation>Zeit in Sekunden. Ziehen Sie die Griffe oder das, was dazwischen ist; über der Linie der gezeigte Moment.
Tasten: links und rechts, Leertaste für den anderen Griff.</translation>
    </message>
    <message>
        <source>All at once</source>
        <translation>Alles zugleich</translation>
    </message>
    <message>
        <source>Stop, and show the whole time window at once.</source>
        <translation>Anhalten, und das ganze Zeitfenster auf einmal zeigen.</translation>
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
        <source>Seconds of the recording that pass in one second.</source>
        <translation>Sekunden der Aufzeichnung, die in einer Sekunde vergehen.</translation>
    </message>
    <message>
        <source>touches stay</source>
        <translation>Berührungen bleiben</translation>
    </message>
    <message>
        <source>last {seconds:g} s</source>
        <translation>letzte {seconds:g} s</translation>
    </message>
    <message>
        <source>What is shown while playing</source>
        <translation>Was beim Abspielen gezeigt wird</translation>
    </message>
    <message>
        <source>While playing: all since the start, or only the last seconds.</source>
        <translation>Beim Abspielen: alles seit dem Beginn, oder nur die letzten Sekunden.</translation>
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
        <source>Facets that belong to another region stay there</source>
        <translation>Facetten, die einer anderen Region gehören, bleiben dort</translation>
    </message>
    <message>
        <source>Now click the opposite corner.</source>
        <translation>Klicken Sie jetzt die gegenüberliegende Ecke an.</translation>
    </message>
    <message>
        <source>Each low number must be below the high one.</source>
        <translation>Jede untere Zahl muss kleiner sein als die obere.</translation>
    </message>
    <message>
        <source>Look</source>
        <translation>Ansehen</translation>
    </message>
    <message>
        <source>Turn the view with the left button</source>
        <translation>Die Ansicht mit der linken Taste drehen</translation>
    </message>
    <message>
        <source>Brush</source>
        <translation>Pinsel</translation>
    </message>
    <message>
        <source>Paint the chosen region</source>
        <translation>Die gewählte Region malen</translation>
    </message>
    <message>
        <source>Eraser</source>
        <translation>Radierer</translation>
    </message>
    <message>
        <source>Take facets out of their region</source>
        <translation>Facetten aus ihrer Region nehmen</translation>
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
        <source>Everything between two corners</source>
        <translation>Alles zwischen zwei Ecken</translation>
    </message>
    <message>
        <source>Half</source>
        <translation>Hälfte</translation>
    </message>
    <message>
        <source>Everything on one side of a plane</source>
        <translation>Alles auf einer Seite einer Ebene</translation>
    </message>
    <message>
        <source>{0} (regions)</source>
        <translation>{0} (Regionen)</translation>
    </message>
    <message>
        <source>Choose a tool. The right button always turns the view.</source>
        <translation>Wählen Sie ein Werkzeug. Die rechte Taste dreht immer die Ansicht.</translation>
    </message>
    <message>
        <source>Radius</source>
        <translation>Radius</translation>
    </message>
    <message>
        <source>Radius of the brush</source>
        <translation>Radius des Pinsels</translation>
    </message>
    <message>
        <source>[ and ], or Ctrl and the wheel</source>
        <translation>[ und ], oder Strg und das Mausrad</translation>
    </message>
    <message>
        <source>Radius of the brush, mm</source>
        <translation>Radius des Pinsels, mm</translation>
    </message>
    <message>
        <source>Drag over the probe. Shift: the other way. Esc: take the stroke back.</source>
        <translation>Über die Sonde ziehen. Umschalt: umgekehrt. Esc: Strich zurücknehmen.</translation>
    </message>
    <message>
        <source>Edges over</source>
        <translation>Kanten über</translation>
    </message>
    <message>
        <source>Sharpest edge that is crossed</source>
        <translation>Schärfste Kante, über die es geht</translation>
    </message>
    <message>
        <source>Sharpest edge that is crossed, degrees</source>
        <translation>Schärfste Kante, über die es geht, in Grad</translation>
    </message>
    <message>
        <source>Edges sharper than this stop the fill, degrees</source>
        <translation>Schärfere Kanten halten das Füllen auf, in Grad</translation>
    </message>
    <message>
        <source>Take away instead</source>
        <translation>Stattdessen wegnehmen</translation>
    </message>
    <message>
        <source>Click on the probe: everything up to such edges is filled.</source>
        <translation>Auf die Sonde klicken: Alles bis zu solchen Kanten wird gefüllt.</translation>
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
        <source>Click on the probe to move the plane there, or type the number.</source>
        <translation>Auf die Sonde klicken, um die Ebene dorthin zu legen, oder die Zahl eingeben.</translation>
    </message>
    <message>
        <source>Which side of the plane</source>
        <translation>Welche Seite der Ebene</translation>
    </message>
    <message>
        <source>{0} above</source>
        <translation>{0} über</translation>
    </message>
    <message>
        <source>{0} below</source>
        <translation>{0} unter</translation>
    </message>
    <message>
        <source>Where the plane is, mm in the sensor frame S</source>
        <translation>Wo die Ebene liegt, mm im Sensorsystem S</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Take away</source>
        <translation>Wegnehmen</translation>
    </message>
    <message>
        <source>Take these facets out of the chosen region</source>
        <translation>Diese Facetten aus der gewählten Region nehmen</translation>
    </message>
    <message>
        <source>Give these facets to the chosen region</source>
        <translation>Diese Facetten der gewählten Region geben</translation>
    </message>
    <message>
        <source>Click two opposite corners on the probe, or type the numbers.</source>
        <translation>Zwei gegenüberliegende Ecken auf der Sonde anklicken, oder die Zahlen eingeben.</translation>
    </message>
</context>
<context>
    <name>TouchPanel</name>
    <message>
        <source>Start touching</source>
        <translation>Berühren beginnen</translation>
    </message>
    <message>
        <source>Finish</source>
        <translation>Beenden</translation>
    </message>
    <message>
        <source>Keep the recording, judge it, and make the report</source>
        <translation>Die Aufzeichnung behalten, beurteilen und den Bericht machen</translation>
    </message>
    <message>
        <source>Throw away</source>
        <translation>Verwerfen</translation>
    </message>
    <message>
        <source>End without a verdict; the touches are not kept</source>
        <translation>Ohne Urteil beenden; die Berührungen werden nicht behalten</translation>
    </message>
    <message>
        <source>Touch again</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>The marker that is selected in the table, or else the last one; all its touches count</source>
        <translation>Der Marker, der in der Tabelle gewählt ist, sonst der letzte; alle seine Berührungen zählen</translation>
    </message>
    <message>
        <source>Leave it out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>Go on with the marker after the next one; you say why, and the report repeats it</source>
        <translation>Mit dem übernächsten Marker weitermachen; Sie sagen, warum, und der Bericht wiederholt es</translation>
    </message>
    <message>
        <source>Touch it for me</source>
        <translation>Für mich berühren</translation>
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
        <source>The virtual bench presses one marker after the other</source>
        <translation>Der virtuelle Messplatz drückt auf einen Marker nach dem anderen</translation>
    </message>
    <message>
        <source>Heat map of contacts</source>
        <translation>Heatmap der Kontakte</translation>
    </message>
    <message>
        <source>Colour the probe by where it was touched, in contacts per mm²</source>
        <translation>Die Sonde danach färben, wo sie berührt wurde, in Kontakten pro mm²</translation>
    </message>
    <message>
        <source>Mute the tones</source>
        <translation>Töne stumm schalten</translation>
    </message>
    <message>
        <source>A tone for each state; press to mute them</source>
        <translation>Ein Ton für jeden Zustand; drücken, um sie stumm zu schalten</translation>
    </message>
    <message>
        <source>Tones are muted</source>
        <translation>Die Töne sind stumm</translation>
    </message>
    <message>
        <source>Leave {name} out</source>
        <translation>{name} auslassen</translation>
    </message>
    <message>
        <source>Why is {name} not touched? The report says so.</source>
        <translation>Warum wird {name} nicht berührt? Der Bericht sagt es.</translation>
    </message>
    <message>
        <source>nothing reaches it</source>
        <translation>nichts kommt dorthin</translation>
    </message>
    <message>
        <source>the mark cannot be seen any more</source>
        <translation>die Markierung ist nicht mehr zu sehen</translation>
    </message>
    <message>
        <source>the housing gives way there</source>
        <translation>das Gehäuse gibt dort nach</translation>
    </message>
    <message>
        <source>a touch there would do damage</source>
        <translation>eine Berührung dort würde Schaden anrichten</translation>
    </message>
    <message>
        <source>{name} is not left out: that needs a reason.</source>
        <translation>{name} wird nicht ausgelassen: Das braucht einen Grund.</translation>
    </message>
    <message>
        <source>{name} is not left out: it was touched meanwhile.</source>
        <translation>{name} wird nicht ausgelassen: Es wurde inzwischen berührt.</translation>
    </message>
    <message>
        <source>{name} is left out: {why}. The verdict and the report say so.</source>
        <translation>{name} wird ausgelassen: {why}. Das Urteil und der Bericht sagen es.</translation>
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
        <source>could also be here</source>
        <translation>könnte auch hier sein</translation>
    </message>
    <message>
        <source>could also be here, behind</source>
        <translation>könnte auch hier sein, dahinter</translation>
    </message>
    <message>
        <source>No sensor is open: connect one in step 1, Devices.</source>
        <translation>Kein Sensor ist geöffnet: Verbinden Sie einen in Schritt 1, Geräte.</translation>
    </message>
    <message>
        <source>Place markers first, on the first tab.</source>
        <translation>Setzen Sie zuerst Marker, auf der ersten Karteikarte.</translation>
    </message>
    <message>
        <source>Take everything off the probe, then start. From then on, only touch: no mouse is needed.</source>
        <translation>Nehmen Sie alles von der Sonde weg und starten Sie. Von da an nur noch berühren: Eine Maus wird nicht gebraucht.</translation>
    </message>
    <message>
        <source>Press with {low} to {high} N, and hold still.</source>
        <translation>Mit {low} bis {high} N drücken und still halten.</translation>
    </message>
    <message>
        <source>Bring the force to {low} to {high} N, and hold still.</source>
        <translation>Die Kraft auf {low} bis {high} N bringen und still halten.</translation>
    </message>
    <message>
        <source>Do not move: the samples are taken.</source>
        <translation>Nicht bewegen: Die Messwerte werden aufgenommen.</translation>
    </message>
    <message>
        <source>Let go.</source>
        <translation>Loslassen.</translation>
    </message>
    <message>
        <source>{why} ({force} N). Let go, and touch again.</source>
        <translation>{why} ({force} N). Loslassen und noch einmal berühren.</translation>
    </message>
    <message>
        <source>{marker}: {size} mm off.</source>
        <translation>{marker}: {size} mm daneben.</translation>
    </message>
    <message>
        <source>{marker}: {size} mm off. Let go.</source>
        <translation>{marker}: {size} mm daneben. Loslassen.</translation>
    </message>
    <message>
        <source>Confidence {percent} %</source>
        <translation>Sicherheit {percent} %</translation>
    </message>
    <message>
        <source>{sure}, because of the declared regions: the wrench fits another place, too.</source>
        <translation>{sure}, wegen der festgelegten Regionen: Der Messwert passt auch zu einer anderen Stelle.</translation>
    </message>
    <message>
        <source>{sure}: the wrench fits another place, too. Press in another direction.</source>
        <translation>{sure}: Der Messwert passt auch zu einer anderen Stelle. Drücken Sie in eine andere Richtung.</translation>
    </message>
    <message>
        <source>A second touch joined: both are shown.</source>
        <translation>Eine zweite Berührung kam dazu: Beide sind gezeigt.</translation>
    </message>
    <message>
        <source>No single touch explains this wrench: {sigmas} sigma left over, torque arm {arm} mm. Two touches at once, or wrong units, mount or compensation?</source>
        <translation>Keine einzelne Berührung erklärt diesen Messwert: {sigmas} Sigma bleiben übrig, Hebelarm des Moments {arm} mm. Zwei Berührungen zugleich, oder falsche Einheiten, Einbaulage oder Kompensation?</translation>
    </message>
    <message>
        <source>The force is almost parallel to the surface: press more steeply.</source>
        <translation>Die Kraft ist fast parallel zur Oberfläche: Drücken Sie steiler.</translation>
    </message>
    <message>
        <source>The contact is outside every region.</source>
        <translation>Der Kontakt liegt außerhalb aller Regionen.</translation>
    </message>
    <message>
        <source>The sensor is at the end of its range: press less hard.</source>
        <translation>Der Sensor ist am Ende seines Messbereichs: Drücken Sie weniger fest.</translation>
    </message>
    <message>
        <source>No part of the probe faces this force: check that it is the force on the probe, and the mount.</source>
        <translation>Kein Teil der Sonde ist dieser Kraft zugewandt: Prüfen Sie, ob es die Kraft auf die Sonde ist, und die Einbaulage.</translation>
    </message>
    <message>
        <source>On a facet that the mesh file did not have: its place is a guess.</source>
        <translation>Auf einer Facette, die die Netzdatei nicht hatte: Ihre Lage ist geschätzt.</translation>
    </message>
    <message>
        <source>On a region marked untouchable: check the region and the mount.</source>
        <translation>Auf einer Region, die als unberührbar markiert ist: Prüfen Sie die Region und die Einbaulage.</translation>
    </message>
    <message>
        <source>All markers are touched; touches: {done}. Finish, or touch some once more.</source>
        <translation>Alle Marker sind berührt; Berührungen: {done}. Beenden Sie, oder berühren Sie einige noch einmal.</translation>
    </message>
    <message>
        <source>Next: {name} · {done} of {wanted} touches</source>
        <translation>Als Nächstes: {name} · {done} von {wanted} Berührungen</translation>
    </message>
    <message>
        <source>of the touches that count</source>
        <translation>der Berührungen, die zählen</translation>
    </message>
    <message>
        <source>largest {largest} mm; the last was {ratio} times what noise explains</source>
        <translation>größter {largest} mm; zuletzt das {ratio}-Fache des Rauschens</translation>
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
        <source>{name} was pressed {count} times and never counted ({why}). Press Leave it out and then Touch all again, or throw the touches away and move the marker.</source>
        <translation>{name} wurde {count}-mal gedrückt und nie gezählt ({why}). Drücken Sie „Auslassen“ und dann wieder „Alle berühren“, oder verwerfen Sie die Berührungen und verschieben Sie den Marker.</translation>
    </message>
    <message>
        <source>no touch came of it</source>
        <translation>es wurde keine Berührung daraus</translation>
    </message>
</context>
<context>
    <name>TradeoffChart</name>
    <message>
        <source>facets</source>
        <translation>Facetten</translation>
    </message>
    <message>
        <source>time of a solve, µs</source>
        <translation>Zeit einer Lösung, µs</translation>
    </message>
    <message>
        <source>time of the plain loop, µs</source>
        <translation>Zeit der einfachen Schleife, µs</translation>
    </message>
    <message>
        <source>What the chart shows across</source>
        <translation>Was das Diagramm waagerecht zeigt</translation>
    </message>
    <message>
        <source>What the chart shows across: facets, or µs of one solve</source>
        <translation>Was das Diagramm waagerecht zeigt: Facetten, oder µs einer Lösung</translation>
    </message>
    <message>
        <source>Error, mm, against</source>
        <translation>Fehler, mm, über</translation>
    </message>
    <message>
        <source>How far 95 % of the contacts move at most, against all facets, mm</source>
        <translation>Wie weit sich 95 % der Kontakte höchstens verschieben, gegenüber allen Facetten, mm</translation>
    </message>
    <message>
        <source>Contact error against the number of facets</source>
        <translation>Kontaktfehler über der Anzahl der Facetten</translation>
    </message>
    <message>
        <source>allowed {:.2g} mm</source>
        <translation>erlaubt {:.2g} mm</translation>
    </message>
    <message>
        <source>knee</source>
        <translation>Knick</translation>
    </message>
    <message>
        <source>Choose a point: by a click, or by the arrow keys.</source>
        <translation>Wählen Sie einen Punkt: mit einem Klick oder den Pfeiltasten.</translation>
    </message>
    <message>
        <source>{:,} facets: contacts move by up to {:.2g} mm, a solve takes {:.2g} µs.</source>
        <translation>{:,} Facetten: Kontakte verschieben sich um bis zu {:.2g} mm, eine Lösung dauert {:.2g} µs.</translation>
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
        <source>Refused: it must not be used</source>
        <translation>Abgelehnt: darf nicht benutzt werden</translation>
    </message>
    <message>
        <source>Not yet</source>
        <translation>Noch nicht</translation>
    </message>
</context>
<context>
    <name>VerifyPage</name>
    <message>
        <source>Verify</source>
        <translation>Prüfen</translation>
    </message>
    <message>
        <source>Go there</source>
        <translation>Dorthin</translation>
    </message>
    <message>
        <source>Markers</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>How</source>
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
        <source>Drawing the heat map</source>
        <translation>Die Heatmap wird gezeichnet</translation>
    </message>
    <message>
        <source>All devices give samples again; the recording goes on.</source>
        <translation>Alle Geräte liefern wieder Messwerte; die Aufzeichnung geht weiter.</translation>
    </message>
    <message>
        <source>Keeping the recording</source>
        <translation>Die Aufzeichnung wird behalten</translation>
    </message>
    <message>
        <source>Reading the verification</source>
        <translation>Die Überprüfung wird gelesen</translation>
    </message>
    <message>
        <source>Loading the probe</source>
        <translation>Die Sonde wird geladen</translation>
    </message>
    <message>
        <source>Measuring the noise</source>
        <translation>Das Rauschen wird gemessen</translation>
    </message>
    <message>
        <source>The verification passed.</source>
        <translation>Die Überprüfung ist bestanden.</translation>
    </message>
    <message>
        <source>The verification did not pass.</source>
        <translation>Die Überprüfung ist nicht bestanden.</translation>
    </message>
    <message>
        <source>Judging the touches</source>
        <translation>Die Berührungen werden beurteilt</translation>
    </message>
    <message>
        <source>Ending the recording</source>
        <translation>Die Aufzeichnung wird beendet</translation>
    </message>
</context>
<context>
    <name>VerifySettingsPanel</name>
    <message>
        <source>Lower end of the force window, N</source>
        <translation>Unteres Ende des Kraftfensters, N</translation>
    </message>
    <message>
        <source>Upper end of the force window, N</source>
        <translation>Oberes Ende des Kraftfensters, N</translation>
    </message>
    <message>
        <source>Accepted touches wanted of each marker</source>
        <translation>Gewünschte gezählte Berührungen jedes Markers</translation>
    </message>
    <message>
        <source>Samples taken of each touch, once it has settled</source>
        <translation>Messwerte je Berührung, sobald sie ruhig ist</translation>
    </message>
    <message>
        <source>any order</source>
        <translation>beliebig</translation>
    </message>
    <message>
        <source>as in the table</source>
        <translation>wie in der Tabelle</translation>
    </message>
    <message>
        <source>In which order markers are touched</source>
        <translation>In welcher Reihenfolge Marker berührt werden</translation>
    </message>
    <message>
        <source>In any order a touch is of the marker that it is near; in the table&apos;s order, of the next one.</source>
        <translation>Bei beliebiger Reihenfolge gilt eine Berührung dem Marker, dem sie nahe ist; nach der Tabelle dem nächsten.</translation>
    </message>
    <message>
        <source>Largest mean error that passes, mm</source>
        <translation>Größter mittlerer Fehler, mit dem bestanden wird, mm</translation>
    </message>
    <message>
        <source>Largest error that passes, mm</source>
        <translation>Größter Fehler, mit dem bestanden wird, mm</translation>
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
        <source>Each marker</source>
        <translation>Jeder Marker</translation>
    </message>
    <message>
        <source>Samples</source>
        <translation>Messwerte</translation>
    </message>
    <message>
        <source>Touch in</source>
        <translation>Reihenfolge</translation>
    </message>
    <message>
        <source>Mean error up to</source>
        <translation>Mittel bis</translation>
    </message>
    <message>
        <source>Any error up to</source>
        <translation>Einzeln bis</translation>
    </message>
    <message>
        <source>Order of touches</source>
        <translation>Reihenfolge der Berührungen</translation>
    </message>
    <message>
        <source>Touches of each marker</source>
        <translation>Berührungen jedes Markers</translation>
    </message>
    <message>
        <source>Samples of each touch</source>
        <translation>Messwerte jeder Berührung</translation>
    </message>
    <message>
        <source>Limit of the mean error</source>
        <translation>Grenze des mittleren Fehlers</translation>
    </message>
    <message>
        <source>Limit of any error</source>
        <translation>Grenze jedes Fehlers</translation>
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
        <source>Look from the front: x to the right, z upwards</source>
        <translation>Von vorn ansehen: x nach rechts, z nach oben</translation>
    </message>
    <message>
        <source>Side</source>
        <translation>Seite</translation>
    </message>
    <message>
        <source>Look from the side: y to the right, z upwards</source>
        <translation>Von der Seite ansehen: y nach rechts, z nach oben</translation>
    </message>
    <message>
        <source>Top</source>
        <translation>Oben</translation>
    </message>
    <message>
        <source>Look at the tip from above: x to the right, y upwards</source>
        <translation>Von oben auf die Spitze sehen: x nach rechts, y nach oben</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>Einpassen</translation>
    </message>
    <message>
        <source>Show the whole probe; the direction stays</source>
        <translation>Die ganze Sonde zeigen; die Richtung bleibt</translation>
    </message>
    <message>
        <source>Perspective</source>
        <translation>Perspektive</translation>
    </message>
    <message>
        <source>What is nearer looks larger; lengths are then not true, so there is no scale</source>
        <translation>Was näher ist, wirkt größer; Längen stimmen dann nicht, deshalb gibt es keinen Maßstab</translation>
    </message>
</context>
<context>
    <name>ViewerWork</name>
    <message>
        <source>Stopped; nothing was changed.</source>
        <translation>Angehalten; nichts wurde geändert.</translation>
    </message>
    <message>
        <source>Something went wrong that should not have: {what}.</source>
        <translation>Es ist etwas schiefgegangen, was nicht sein sollte: {what}.</translation>
    </message>
</context>
<context>
    <name>WeightPanel</name>
    <message>
        <source>Known weight</source>
        <translation>Bekanntes Gewicht</translation>
    </message>
    <message>
        <source>Hang a weight of known mass on the tool. It shows a wrong unit, sign or scale of the sensor, which poses cannot show.</source>
        <translation>Ein Gewicht bekannter Masse an das Werkzeug hängen. Das zeigt eine falsche Einheit, ein falsches Vorzeichen oder eine falsche Skala des Sensors, die Posen nicht zeigen können.</translation>
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
        <source>Number, if there is one</source>
        <translation>Nummer, falls vorhanden</translation>
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
        <source>Take everything off the tool, and hold it still.</source>
        <translation>Alles vom Werkzeug nehmen und es still halten.</translation>
    </message>
    <message>
        <source>Read. Now hang the weight on the tool, wait until it is at rest, then press 2.</source>
        <translation>Gemessen. Jetzt das Gewicht an das Werkzeug hängen, warten, bis es ruht, dann 2 drücken.</translation>
    </message>
    <message>
        <source>Wait until the weight is at rest.</source>
        <translation>Warten, bis das Gewicht ruht.</translation>
    </message>
</context>
<context>
    <name>_Missing</name>
    <message>
        <source>This page could not be made; the messages say why. The other steps can be used.</source>
        <translation>Diese Seite konnte nicht gemacht werden; die Meldungen sagen, warum. Die anderen Schritte können benutzt werden.</translation>
    </message>
</context>
</TS>
